"""How a node ends, for whoever starts it. No ROS."""

REFUSED = 2  # exit code of a node that cannot run with its parameters
ERROR = "error: "  # begins the last line of a node that something has stopped
TRACEBACK = "traceback"  # logger that shows at level debug where an error in a user's code came from
