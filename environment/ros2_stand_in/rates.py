"""`ros2 topic hz`: at what rate messages arrive, by the clock on the wall."""

import sys
import time
from collections import deque
from statistics import fmean, pstdev

from rclpy.qos import QoSProfile, QoSReliabilityPolicy

from environment.ros2_stand_in.session import Session, absolute, interface
from environment.ros2_stand_in.terminal import line, lines

_EVERY = 1.0  # s between reports
# whoever publishes reliably reaches such a one as well, and is not held up by it
_QOS = QoSProfile(depth=1000, reliability=QoSReliabilityPolicy.BEST_EFFORT)


def hz(chosen):
    """Print every second until interrupted."""
    topic = absolute(chosen.topic_name)
    with Session() as session:
        try:
            kind = interface(_type_of(session, topic, chosen.spin_time), "msg")
            steps, last = deque(maxlen=chosen.window - 1 or 1), [None]

            def on_message(_data):
                now = time.monotonic()
                if last[0] is not None:
                    steps.append(now - last[0])
                last[0] = now

            session.node.create_subscription(kind, topic, on_message, _QOS, raw=True)
            while True:
                before, due = last[0], time.monotonic() + _EVERY
                session.wait_until(lambda due=due: time.monotonic() > due)
                if steps and last[0] != before:
                    _report(steps)
        except KeyboardInterrupt:
            return


def _type_of(session, topic, quiet):
    """Wait for a topic; returns the name of its type."""
    types = session.find_topic(topic, quiet)
    if not types:
        line(f"WARNING: topic [{topic}] does not appear to be published yet", sys.stderr)
    while not types:
        types = session.find_topic(topic, quiet)
    return types[0]


def _report(steps):
    lines(
        f"average rate: {1.0 / max(fmean(steps), 1e-12):.3f}\n"
        f"\tmin: {min(steps):.3f}s max: {max(steps):.3f}s std dev: {pstdev(steps):.5f}s window: {len(steps) + 1}"
    )
