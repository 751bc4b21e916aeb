"""A measured drive beside a simulated one: ratios of levels and their confidence intervals.

windows (spectra of short windows, reduced to the powers of bands), bands (which those are), intervals (of ratios, by
the jackknife), compare (all of it, and the records that come out).
"""
