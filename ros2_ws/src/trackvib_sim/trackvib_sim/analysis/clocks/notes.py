"""What was found of a sensor's clock and done about it, in sentences."""

NOTABLE = 0.01  # of a period, by which stamps must be off the line to be spoken of


def clock_notes(end, clock):
    """Say in sentences what was found of a sensor's clock and done about it."""
    period = 1.0 / clock.rate
    notes = []
    if clock.correction > NOTABLE * period:
        notes.append(
            f"{end}: stamps are not even ({clock.steps}); sample times are taken from a robust line through them, at "
            f"{clock.rate:.7g} Hz; stamps deviate from it by {1e3 * clock.jitter:.3g} ms RMS and "
            f"{1e3 * clock.correction:.3g} ms at most, {clock.correction / period:.2g} periods"
        )
    if clock.counted_by_log and notes:
        notes.append(f"{end}: the time base is the times of recording, which are steadier")
    for count, text in (
        (clock.lost, "samples are missing between others"),
        (clock.repeated, "stamps repeat the previous one"),
        (clock.disordered, "samples were sorted by their stamps"),
        (clock.copies, "messages are in the recording twice, duplicates left out"),
        (clock.left_out, "samples are isolated or next to lost ones, left out"),
    ):
        if count:
            notes.append(f"{end}: {count} {text}")
    for step, witnessed in clock.settings:
        what = "corrected, since the recorder's clock did not jump" if witnessed else "split there"
        notes.append(f"{end}: the clock was set {'ahead' if step > 0 else 'back'} by {abs(step):.6g} s: {what}")
    return notes
