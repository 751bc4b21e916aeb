"""Kinds of hostile inputs: each module has `trials`, which makes them, and `REFUSALS`, in which they may end.

`trials(chance, count)` yields what was done to an input, in words, and a function that tries it: it returns the kind of
outcome, or raises a refusal, or `Wrong`.
"""
