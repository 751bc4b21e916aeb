"""Words on a drawing that find their own places: where least is drawn already, near what they belong to.

What is drawn is taken from the picture itself: wherever neighbouring pixels differ there is ink. An even area is free.
"""

from typing import NamedTuple

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

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
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        figure.set_layout_engine("none")
        paper = _Paper(canvas)
        for label in self._labels:
            self._write(label, paper)

    def _write(self, label, paper):
        size = paper.size(label)
        to_pixels = label.plot.transData.transform
        point, region = to_pixels(label.point), label.plot.get_window_extent()
        away = _DISTANCES[:, None, None] * np.stack((np.cos(_ANGLES), np.sin(_ANGLES)), axis=-1)
        led = point + away.reshape(-1, 2)
        middles, is_led = led, np.full(len(led), True)
        if label.box is not None:
            low, high = to_pixels(label.box[0]) + 0.5 * size + _AROUND, to_pixels(label.box[1]) - 0.5 * size - _AROUND
            if np.all(low < high):
                grid = np.stack(np.meshgrid(*np.linspace(low, high, _STEPS).T), axis=-1).reshape(-1, 2)
                middles, is_led = np.concatenate((led, grid)), np.repeat((True, False), (len(led), len(grid)))
        others = [np.concatenate((to_pixels(low), to_pixels(high))) for low, high in label.others]
        inside = _within(middles, size, region)
        if inside.any():
            middles, is_led = middles[inside], is_led[inside]
        best = int(np.argmin(paper.costs(middles, size, point, is_led, others)))
        middle, led = middles[best], is_led[best]
        paper.take(middle, size, point if led else None)
        place = label.plot.transData.inverted().transform(middle)
        if led:
            leader(label.plot, label.words, label.point, place, label.colour)
        else:
            text(label.plot, label.words, place, color=label.colour, bbox=None)


def _within(middles, size, region):
    low, high = middles - 0.5 * size, middles + 0.5 * size
    return np.all((low >= (region.x0, region.y0)) & (high <= (region.x1, region.y1)), axis=-1)


class _Paper:
    """The pixels of a figure, rows from below."""

    def __init__(self, canvas):
        self._renderer = canvas.get_renderer()
        pixels = np.asarray(canvas.buffer_rgba())[::-1, :, :3].astype(np.int16)
        self.ink = np.zeros(pixels.shape[:2], np.int32)
        for axis in (0, 1):
            differs = np.abs(np.diff(pixels, axis=axis)).max(axis=-1) > _DIFFERENT
            self.ink[: differs.shape[0], : differs.shape[1]] += differs
        self.words = np.zeros_like(self.ink)
        self._ink_sum, self._words_sum = _summed(self.ink), _summed(self.words)

    def size(self, label):
        """Return width and height (2,) of words [px]."""
        trial = label.plot.text(*label.point, label.words, fontsize=TEXT, linespacing=1.2)
        extent = trial.get_window_extent(self._renderer)
        trial.remove()
        return np.array([extent.width, extent.height])

    def costs(self, middles, size, point, led, others):
        """Return what words for a `point` cost at places (k, 2) [px], `led` there by a leader or not (k,): (k,)."""
        low, high = middles - 0.5 * size - _AROUND, middles + 0.5 * size + _AROUND
        costs = _FAR * np.hypot(*(middles - point).T)
        costs += _ON_INK * self._count(self._ink_sum, low, high) + _ON_WORDS * self._count(self._words_sum, low, high)
        for box in others:
            overlap = np.minimum(high, box[2:]) - np.maximum(low, box[:2])
            costs += _ELSEWHERE * np.prod(np.maximum(overlap, 0.0), axis=-1)
        pixels, drawn = self._lines(middles[led], size, point)
        x, y = np.moveaxis(pixels, -1, 0)
        costs[led] += _LED + np.sum(drawn * (_CROSSED * self.ink[y, x] + _ON_WORDS * self.words[y, x]), axis=-1)
        costs[led & np.all((low < point) & (point < high), axis=-1)] = np.inf
        return costs

    def take(self, middle, size, point):
        """Mark the place of words, and their leader's, as taken."""
        (x0, y0), (x1, y1) = self._clip(middle - 0.5 * size), self._clip(middle + 0.5 * size)
        self.words[y0:y1, x0:x1] = 1
        if point is not None:
            pixels, drawn = self._lines(middle[None], size, point)
            x, y = pixels[drawn].T
            self.words[y, x] = 1
        self._words_sum = _summed(self.words)

    def _lines(self, middles, size, point):
        """Return the pixels of leaders from words at (k, 2) to a point, (k, n, 2), and which are theirs (k, n)."""
        starts = middles + np.stack((0.5 * size[0] * np.sign(point[0] - middles[:, 0]), np.zeros(len(middles))), -1)
        length = np.hypot(*(point - starts).T)
        count = np.maximum(2, length.astype(int))
        number = np.arange(count.max(initial=2))
        share = number / (count - 1)[:, None] * np.maximum(0.0, 1.0 - _NEAR / np.maximum(length, _NEAR))[:, None]
        return self._clip(starts[:, None] + share[..., None] * (point - starts)[:, None]), number < count[:, None]

    def _clip(self, place):
        rows, columns = self.ink.shape
        return np.clip(np.round(place).astype(int), 0, (columns - 1, rows - 1))

    def _count(self, sums, low, high):
        (x0, y0), (x1, y1) = self._clip(low).T, self._clip(high).T
        return sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]


def _summed(pixels):
    """Return the sums over all pixels below and left of each corner."""
    sums = np.zeros(np.add(pixels.shape, 1), pixels.dtype)
    inner = sums[1:, 1:]
    np.cumsum(pixels, axis=1, out=inner)
    np.cumsum(inner, axis=0, out=inner)
    return sums
