"""The Rui method (transfer matrix method) for any tree of rigid bodies and hinges; docs/method.md explains it.

`table` and `state` contain a tree and its motion, `solve` and `closed_chain` give accelerations. Subpackages are
`sweeps` (the production form, compiled), `reference` (plain matrices, forms A and X), `linear` (small motions).
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
