"""What ROS tells of a parameter: type, range, meaning, and whether it is fixed."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor


def descriptor_of(parameter, fixed):
    """Return the ROS descriptor of a `parameters.Parameter`."""
    descriptor = ParameterDescriptor(
        description=f"{parameter.description} [{parameter.unit}]" if parameter.unit else parameter.description,
        additional_constraints=f"accepted: {parameter.accepted}",
        read_only=fixed,
    )
    if parameter.low is not None:
        if isinstance(parameter.default, int):
            limits = IntegerRange(from_value=parameter.low, to_value=parameter.high, step=0)
            descriptor.integer_range = [limits]
        else:
            limits = FloatingPointRange(from_value=parameter.low, to_value=parameter.high, step=0.0)
            descriptor.floating_point_range = [limits]
    return descriptor
