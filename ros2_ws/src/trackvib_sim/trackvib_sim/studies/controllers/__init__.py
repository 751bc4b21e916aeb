"""`study controllers`: control laws beside constant currents."""
