"""Words on a drawing that find their own places: where least is drawn already, near what they belong to.

What is drawn is taken from the picture itself: wherever neighbouring pixels differ there is ink. An even area is free.
"""

from typing import NamedTuple

import numpy as np

from .technical_drawing import INK, TEXT, leader, text

_DISTANCES = np.arange(30.0, 330.0, 15.0)  # px from a point to the middle of its words
_ANGLES = np.radians(np.arange(0.0, 360.0, 15.0))
_STEPS = 12  # of the places within a box, along either side
_DIFFERENT = 12  # of 255, in any colour
_NEAR = 12.0  # px of a leader at its point, where the point's own mark is
_AROUND = 3  # px to be kept free around words
# what a pixel costs that words or leaders lie on, and one of distance
_ON_INK, _ON_WORDS, _ELSEWHERE, _CROSSED, _FAR, _LED = 2.0, 100.0, 2.0, 6.0, 0.6, 60.0


class _Label(NamedTuple):
    plot: object
    words: str
    point: np.ndarray  # (2,) in the plot's coordinates
    colour: str
    box: tuple | None  # (low, high) corners, in which the words need no leader
    others: list  # boxes in which these words would be misread


class Labels:
    """Collects the words of a figure; `write` places them."""

    def __init__(self):
        self._labels = []

    def add(self, plot, words, point, colour=INK, box=None, others=()):
        """Add words for a point, led there by a thin line unless they find a place in their `box`."""
        self._labels.append(_Label(plot, words, np.asarray(point, dtype=float), colour, box, list(others)))

    def write(self, figure):
        """Write all words, the first ones first; the figure's layout stays as it is from then on."""
        figure.canvas.draw()
        figure.set_layout_engine("none")
        paper = _Paper(figure)
        for label in self._labels:
            self._write(label, paper)

    def _write(self, label, paper):
        size = paper.size(label)
        to_pixels = label.plot.transData.transform
        point, region = to_pixels(label.point), label.plot.get_window_extent()
        candidates = [(point + r * np.array([np.cos(a), np.sin(a)]), True) for r in _DISTANCES for a in _ANGLES]
        if label.box is not None:
            low, high = to_pixels(label.box[0]) + 0.5 * size + _AROUND, to_pixels(label.box[1]) - 0.5 * size - _AROUND
            if np.all(low < high):
                grid = np.stack(np.meshgrid(*np.linspace(low, high, _STEPS).T), axis=-1).reshape(-1, 2)
                candidates += [(middle, False) for middle in grid]
        others = [np.concatenate((to_pixels(low), to_pixels(high))) for low, high in label.others]
        inside = [each for each in candidates if _within(each[0], size, region)] or candidates
        costs = [paper.cost(middle, size, point, led, others) for middle, led in inside]
        middle, led = inside[int(np.argmin(costs))]
        paper.take(middle, size, point if led else None)
        place = label.plot.transData.inverted().transform(middle)
        if led:
            leader(label.plot, label.words, label.point, place, label.colour)
        else:
            text(label.plot, label.words, place, color=label.colour, bbox=None)


def _within(middle, size, region):
    low, high = middle - 0.5 * size, middle + 0.5 * size
    return low[0] >= region.x0 and low[1] >= region.y0 and high[0] <= region.x1 and high[1] <= region.y1


class _Paper:
    """The pixels of a figure, rows from below."""

    def __init__(self, figure):
        self._renderer = figure.canvas.get_renderer()
        pixels = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3].astype(int)
        self.ink = np.zeros(pixels.shape[:2])
        for axis in (0, 1):
            differs = np.abs(np.diff(pixels, axis=axis)).max(axis=-1) > _DIFFERENT
            self.ink[: differs.shape[0], : differs.shape[1]] += differs
        self.words = np.zeros(pixels.shape[:2])
        self._sum()

    def _sum(self):
        self._ink_sum, self._words_sum = (
            np.pad(each.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0))) for each in (self.ink, self.words)
        )

    def size(self, label):
        """Return width and height (2,) of words [px]."""
        trial = label.plot.text(*label.point, label.words, fontsize=TEXT, linespacing=1.2)
        extent = trial.get_window_extent(self._renderer)
        trial.remove()
        return np.array([extent.width, extent.height])

    def cost(self, middle, size, point, led, others):
        """Return what words for a `point` cost at a place, with a leader or without."""
        low, high = middle - 0.5 * size - _AROUND, middle + 0.5 * size + _AROUND
        cost = _FAR * np.hypot(*(middle - point))
        cost += _ON_INK * self._count(self._ink_sum, low, high) + _ON_WORDS * self._count(self._words_sum, low, high)
        for box in others:
            overlap = np.minimum(high, box[2:]) - np.maximum(low, box[:2])
            cost += _ELSEWHERE * np.prod(np.maximum(overlap, 0.0))
        if not led:
            return cost
        if np.all((low < point) & (point < high)):
            return np.inf
        x, y = self._line(middle, size, point)
        return cost + _LED + _CROSSED * self.ink[y, x].sum() + _ON_WORDS * self.words[y, x].sum()

    def take(self, middle, size, point):
        """Mark the place of words, and their leader's, as taken."""
        (x0, y0), (x1, y1) = self._clip(middle - 0.5 * size), self._clip(middle + 0.5 * size)
        self.words[y0:y1, x0:x1] = 1.0
        if point is not None:
            x, y = self._line(middle, size, point)
            self.words[y, x] = 1.0
        self._sum()

    def _line(self, middle, size, point):
        start = middle + (0.5 * size[0] * np.sign(point[0] - middle[0]), 0.0)
        length = np.hypot(*(point - start))
        share = np.linspace(0.0, max(0.0, 1.0 - _NEAR / max(length, _NEAR)), max(2, int(length)))
        return self._clip(start + share[:, None] * (point - start)).T

    def _clip(self, place):
        rows, columns = self.ink.shape
        return np.clip(np.round(place).astype(int), 0, (columns - 1, rows - 1))

    def _count(self, sums, low, high):
        (x0, y0), (x1, y1) = self._clip(low), self._clip(high)
        return sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]
