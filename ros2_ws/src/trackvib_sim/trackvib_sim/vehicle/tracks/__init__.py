"""The left and the right track: subsystems of their own, coupled to the body tree by forces only [Tao2025]."""
