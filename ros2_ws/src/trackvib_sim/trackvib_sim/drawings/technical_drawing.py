"""What technical drawings are made of: dimension lines, leaders, boxes, springs, centres of mass, level ground."""

import numpy as np
from matplotlib.patches import Circle, Rectangle, Wedge

INK, FAINT, SHADE = "#3c4248", "#9aa3ab", "#e3e8eb"
TEXT = 8  # points
CLEAR = {"boxstyle": "square,pad=0.12", "facecolor": "white", "edgecolor": "none"}
# order in which things lie over each other
BACK, PARTS, MARKS, WORDS = 1, 4, 8, 12


def drawing(plot, title):
    """Prepare axes for a drawing to scale."""
    plot.set_aspect("equal")
    plot.axis("off")
    plot.set_title(title, fontsize=TEXT + 2, color=INK, loc="left")


def text(plot, words, place, **style):
    """Write words around a place on white ground."""
    style = {"fontsize": TEXT, "color": INK, "ha": "center", "va": "center", "zorder": WORDS, "bbox": CLEAR} | style
    plot.text(*place, words, **style)


def dimension(plot, start, end):
    """Draw a dimension line between two points with their distance."""
    line = {"arrowstyle": "<|-|>", "color": INK, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 7}
    plot.annotate("", start, end, arrowprops=line, zorder=MARKS)
    middle, length = 0.5 * (np.asarray(start) + end), np.hypot(*np.subtract(end, start))
    text(plot, f"{length:.2f}", middle, rotation=90 if start[0] == end[0] else 0)


def extension(plot, start, end):
    """Draw the thin line from a part to its dimension line."""
    plot.plot(*zip(start, end, strict=True), color=FAINT, linewidth=0.5, zorder=PARTS - 1)


def leader(plot, words, point, place, color=INK):
    """Write words around a place and lead a thin line to a point from the end of the words that is nearer to it."""
    line = {"arrowstyle": "-", "color": color, "linewidth": 0.6, "shrinkA": 0, "shrinkB": 2}
    line["relpos"] = (float(point[0] > place[0]), 0.5)
    style = {"fontsize": TEXT, "color": color, "ha": "center", "va": "center", "bbox": CLEAR}
    plot.annotate(words, point, place, arrowprops=line, zorder=WORDS, **style)


def axes_cross(plot, origin, names, size=0.35):
    """Draw the two axes of a view; `names` maps an axis to its direction in the picture."""
    for name, way in names.items():
        end = np.add(origin, size * np.asarray(way))
        plot.annotate("", end, origin, arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0})
        text(plot, name, np.add(origin, 1.25 * size * np.asarray(way)), bbox=None)


def box(plot, centre, sides, **style):
    """Draw an upright rectangle around its centre."""
    style = {"facecolor": "white", "edgecolor": INK, "linewidth": 1.0, "zorder": PARTS} | style
    plot.add_patch(Rectangle(np.asarray(centre) - 0.5 * np.asarray(sides), *sides, **style))


def disc(plot, centre, radius, **style):
    """Draw a circle."""
    style = {"facecolor": "white", "edgecolor": INK, "linewidth": 1.0, "zorder": PARTS} | style
    plot.add_patch(Circle(centre, radius, **style))


def bar(plot, start, end, **style):
    """Draw a stout line."""
    style = {"color": INK, "linewidth": 5, "solid_capstyle": "round", "zorder": PARTS} | style
    plot.plot(*zip(start, end, strict=True), **style)


def spring(plot, end, length=0.26, width=0.05):
    """Draw a spring that stands below its end on a base."""
    across = width * np.array([0, 0, 1, -1, 1, -1, 1, -1, 0, 0])
    down = length * np.array([0.0, 0.12, 0.18, 0.3, 0.42, 0.54, 0.66, 0.78, 0.84, 1.0])
    plot.plot(end[0] + across, end[1] - down, color=INK, linewidth=1.2, zorder=MARKS)
    plot.plot((end[0] - 2 * width, end[0] + 2 * width), [end[1] - length] * 2, color=INK, linewidth=1.8, zorder=MARKS)


def centre_of_mass(plot, centre, radius=0.035):
    """Draw the quartered circle."""
    disc(plot, centre, radius, zorder=MARKS)
    for start in (0.0, 180.0):
        plot.add_patch(Wedge(centre, radius, start, start + 90.0, facecolor=INK, zorder=MARKS))


def level_ground(plot, start, end, depth=0.18):
    """Draw the ground at height zero; it covers what would lie below."""
    below = {"facecolor": "white", "edgecolor": FAINT, "hatch": "/////", "linewidth": 0.0, "zorder": BACK + 1}
    plot.add_patch(Rectangle((start, -depth), end - start, depth, **below))
    plot.plot((start, end), (0.0, 0.0), color=INK, linewidth=1.1, zorder=BACK + 1)
