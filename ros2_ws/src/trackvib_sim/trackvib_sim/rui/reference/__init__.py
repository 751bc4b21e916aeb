"""The reference forms in plain matrices, 13 x 13 a body and hinge: overall transfer equation, forms A and X."""
