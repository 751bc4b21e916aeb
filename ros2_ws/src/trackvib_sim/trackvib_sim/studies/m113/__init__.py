"""`study m113`: the M113 beside an independent code."""
