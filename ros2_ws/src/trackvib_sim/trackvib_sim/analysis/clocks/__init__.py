"""The clocks of recorded sensors: which sample is which, when each was taken, and both sensors on one time base.

order (of the messages in time), settings (a clock that was set while it ran), counting (which samples are lost, and
what is only jitter), line (the robust one through the stamps), mending (all of that, for one sensor), wander (a rate
that is another now and then), resampling (band-limited), time_base (both sensors).

A sensor samples evenly; what its stamps say beyond that is when somebody looked at a clock. Stamps that are even, as
those of a simulator, stay as they are.
"""
