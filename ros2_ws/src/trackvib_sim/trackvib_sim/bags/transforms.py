"""Rotations: of a sensor in the vehicle, as told in degrees or by the static transforms in a bag."""

import numpy as np

TF_STATIC, TF_TYPE = "tf_static", "tf2_msgs/msg/TFMessage"
_DEEPEST = 50  # frames above a sensor's


def transforms_in(message):
    """Return by frame the frame above it and its quaternion (4,) x y z w in that, of a transform message."""
    found = {}
    for each in message.transforms:
        q = each.transform.rotation
        found[_bare(each.child_frame_id)] = _bare(each.header.frame_id), (q.x, q.y, q.z, q.w)
    return found


def rotation_below(transforms, frame, root):
    """Return the rotation (3, 3) of a frame in the one called `root`, in any namespace; None if it is not below it."""
    frame, rotation = _bare(frame), np.eye(3)
    for _ in range(_DEEPEST):
        if frame.rsplit("/", 1)[-1] == root:
            return rotation
        if frame not in transforms:
            return None
        frame, quaternion = transforms[frame]
        turned = rotation_of(np.array([quaternion], float))
        if turned is None:
            return None
        rotation = turned[0] @ rotation
    return None


def rotation_of(quaternion):
    """Return rotations (k, 3, 3) of quaternions (k, 4) x y z w; None if one has no length."""
    length = np.linalg.norm(quaternion, axis=1)
    if not (length > 0.5).all():
        return None
    x, y, z, w = (quaternion / length[:, None]).T
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), 2, 0)


def rotation_by_angles(angles):
    """Return the rotation (3, 3) by roll, pitch, yaw [deg] about the vehicle's fixed axes, in this order (REP-103)."""
    (sr, sp, sy), (cr, cp, cy) = (turn(np.radians(angles)) for turn in (np.sin, np.cos))
    roll = np.array(((1, 0, 0), (0, cr, -sr), (0, sr, cr)))
    pitch = np.array(((cp, 0, sp), (0, 1, 0), (-sp, 0, cp)))
    yaw = np.array(((cy, -sy, 0), (sy, cy, 0), (0, 0, 1)))
    return yaw @ pitch @ roll


def angles_of(rotation):
    """Return roll, pitch, yaw [deg] of a rotation (3, 3)."""
    pitch = np.arcsin(np.clip(-rotation[2, 0], -1.0, 1.0))
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
    return tuple(float(each) for each in np.degrees((roll, pitch, yaw)))


def _bare(frame):
    return frame.lstrip("/")
