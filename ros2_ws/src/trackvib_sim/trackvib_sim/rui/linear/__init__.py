"""Small motions about an equilibrium: natural frequencies, damped poles, frequency responses."""
