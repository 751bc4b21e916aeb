"""Parameters of the simulator node."""

from mr_mount_controller.parameters import Parameter

PARAMETERS = (
    Parameter("vehicle_file", "", "Vehicle file; empty for the one that comes with the package."),
    Parameter("speed", 10.0, "Speed that the driver keeps.", "m/s", 0.0, 25.0),
    Parameter("engine_speed", 1650.0, "Engine speed; 0 for a standing engine.", "r/min", 0.0, 4000.0),
    Parameter(
        "engine_excitation",
        "forces",
        "Forces and moments of each order on the powertrain, or the displacement across the mounts of [Tao2025].",
        choices=("forces", "displacement"),
    ),
    Parameter("duration", 0.0, "Simulated time after which the node ends; 0 for no end.", "s", 0.0, 1e6),
    Parameter(
        "pace",
        "lockstep",
        "Wait for the answer to every sample and run as fast as that allows, or follow the wall clock.",
        choices=("lockstep", "realtime"),
    ),
    Parameter("real_time_factor", 1.0, "Simulated per wall time where pace is realtime.", "", 0.01, 100.0),
    Parameter("answer_timeout", 1.0, "Wall time after which a controller is silent.", "s", 0.001, 60.0),
    Parameter(
        "on_silence",
        "hold",
        "When the controller is silent: hold the last current, fall back to passive_current, or stop.",
        choices=("hold", "passive", "stop"),
    ),
    Parameter("passive_current", 1.0, "Current before the first answer, and of on_silence passive.", "A", 0.0, 5.0),
    Parameter("physics_rate", 10_000, "Rate of the physics steps.", "Hz", 1000, 200_000),
    Parameter("control_rate", 1_000, "Rate of the Imu messages and of the control loop.", "Hz", 10, 10_000),
    Parameter("odometry_rate", 100, "Rate of odometry and /clock.", "Hz", 1, 10_000),
    Parameter("wait_for_recorder", False, "Start only with a recorder, and never run far ahead of it."),
)
