"""The simulation as a Functional Mock-up Unit (FMI 2.0, co-simulation), for other simulators."""
