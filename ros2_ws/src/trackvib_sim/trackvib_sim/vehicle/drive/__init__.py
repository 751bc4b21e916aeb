"""How the vehicle is driven: what is wanted, the path, the driver, the engine and what lies behind it."""
