"""Which mounts a bag is of, as it describes them or as the numbers of its messages tell."""

from mr_mount_controller.mounting import MOST_COILS, MOST_MOUNTS, undescribed
from mr_mount_controller.node_base import topics


def mounting_of(told, mounts, answers):
    """Return the `Mounting` that is described, or else of as many coils and mounts as there are numbers.

    Parameters
    ----------
    told : Mounting or None
        As it is described.
    mounts : Mounts or None
    answers : Answers or None

    Raises
    ------
    ValueError
        Numbers contradict each other or what is described, or are too many.
    """
    if mounts is None:
        coils = count = told.coils if told else 2 if answers is None else answers.current.shape[1]
    else:
        coils, (count, *others) = mounts.current.shape[1], (column.shape[1] for column in mounts[2:])
        if any(other != count for other in others) or coils > count:
            raise ValueError(f"{topics.MOUNT_STATE} has {coils} currents and {count}, {others} numbers of mounts")
    if coils > MOST_COILS or count > MOST_MOUNTS:
        raise ValueError(f"it has {coils} coils and {count} mounts, accepted: {MOST_COILS} and {MOST_MOUNTS}")
    if told is None:
        return undescribed(coils, count)
    if mounts is not None and (told.coils, len(told.mounts)) != (coils, count):
        raise ValueError(
            f"{topics.MOUNT_DESCRIPTION} describes {told.coils} coils and {len(told.mounts)} mounts, "
            f"{topics.MOUNT_STATE} has {coils} and {count}"
        )
    return told
