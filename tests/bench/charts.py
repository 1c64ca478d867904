"""Log-log plots as SVG, many small ones in a grid with one legend."""

import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 300, 220          # of a panel with its labels, px
LEFT, RIGHT, TOP, BOTTOM = 46, 10, 26, 34
INK, SOFT, GRID = "#222222", "#555555", "#dddddd"


class Axis:
    """Maps log values to pixels."""

    def __init__(self, values, start, stop):
        self.low, self.high = math.log10(min(values)), math.log10(max(values))
        if self.high - self.low < 0.05:
            self.low, self.high = self.low - 0.025, self.high + 0.025
        self.start, self.stop = start, stop

    def at(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.stop - self.start)

    def ticks(self):
        """Decades; with 2 and 5 between them where there are few."""
        steps = (1, 2, 5) if self.high - self.low < 1.7 else (1,)
        exponents = range(math.floor(self.low), math.ceil(self.high) + 1)
        values = [step * 10.0 ** exponent for exponent in exponents for step in steps]
        return [v for v in values if self.low - 1e-9 <= math.log10(v) <= self.high + 1e-9]


def _text(x, y, text, anchor="middle", size=10, colour=SOFT, extra=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{colour}"{extra}>'
            f'{escape(text)}</text>')


def _panel(title, curves, colours, left, top):
    points = [p for curve in curves.values() for p in curve]
    parts = [_text(left + LEFT, top + 16, title, "start", 12, INK, ' font-weight="bold"')]
    x = Axis([p["x"] for p in points], left + LEFT, left + WIDTH - RIGHT)
    y = Axis([v for p in points for v in (p["mean"], p["low"] or p["mean"], p["high"] or p["mean"]) if v > 0.0],
             top + HEIGHT - BOTTOM, top + TOP)
    for value in x.ticks():
        parts.append(f'<path d="M{x.at(value):.1f} {y.stop}V{y.start}" stroke="{GRID}"/>')
        parts.append(_text(x.at(value), y.start + 13, f"{value:g}"))
    for value in y.ticks():
        parts.append(f'<path d="M{x.start} {y.at(value):.1f}H{x.stop}" stroke="{GRID}"/>')
        parts.append(_text(x.start - 5, y.at(value) + 3.5, f"{value:g}", "end"))
    for name, curve in curves.items():
        place = [(x.at(p["x"]), p) for p in curve]
        if all(p["low"] for p in curve):
            outline = [(at, p["low"]) for at, p in place] + [(at, p["high"]) for at, p in reversed(place)]
            corners = " ".join(f"{at:.1f},{y.at(v):.1f}" for at, v in outline)
            parts.append(f'<polygon points="{corners}" fill="{colours[name]}" opacity="0.15"/>')
        line = " ".join(f"{at:.1f},{y.at(p['mean']):.1f}" for at, p in place)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colours[name]}" stroke-width="1.5" '
                     f'stroke-linejoin="round"><title>{escape(name)}</title></polyline>')
    return parts


def panels(curves, colours, x_title, y_title, columns=3):
    """curves: {panel's title: {name: [{x, mean, low, high}]}}, all > 0 (low and high may be None);
    colours: {name: colour}. Returns the text of an SVG file."""
    columns = min(columns, len(curves))
    rows = math.ceil(len(curves) / columns)
    width, legend = columns * WIDTH, 30
    parts = []
    for i, (title, lines) in enumerate(curves.items()):
        parts += _panel(title, lines, colours, i % columns * WIDTH, legend + i // columns * HEIGHT)
    at = LEFT
    for name, colour in colours.items():
        parts.append(f'<path d="M{at} 16h18" stroke="{colour}" stroke-width="2.5"/>')
        parts.append(_text(at + 23, 19.5, name, "start", 11, INK))
        at += 38 + 7 * len(name)
    width = max(width, at)
    height = legend + rows * HEIGHT + 14
    parts.append(_text(width / 2, height - 10, f"{y_title} against {x_title}", size=11, colour=INK))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
            f'height="{height}" font-family="sans-serif">\n<rect width="100%" height="100%" fill="#ffffff"/>\n'
            + "\n".join(parts) + "\n</svg>\n")
