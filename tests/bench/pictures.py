"""PNG files with 8 bits a channel, without interlacing, as vkcppm writes them: read, cut out, put together, written."""

import struct
import zlib

CHANNELS = {0: 1, 2: 3, 6: 4}  # by colour type


class Picture:
    """rows: [height][width] of (r, g, b)."""

    def __init__(self, rows):
        self.rows = rows
        self.width, self.height = len(rows[0]), len(rows)

    def crop(self, left, top, width, height):
        """The box of so many pixels."""
        return Picture([row[left:left + width] for row in self.rows[top:top + height]])

    def enlarged(self, factor):
        """Every pixel as factor x factor pixels."""
        return Picture([row for line in self.rows for row in [[p for p in line for _ in range(factor)]] * factor])


def montage(grid, gap=4, background=(255, 255, 255)):
    """Pictures of one size, [[Picture]], side by side and below one another."""
    rows = []
    for pictures in grid:
        if rows:
            rows += [[background] * len(rows[0])] * gap
        for y in range(pictures[0].height):
            row = []
            for picture in pictures:
                row += ([background] * gap if row else []) + picture.rows[y]
            rows.append(row)
    return Picture(rows)


def _unfiltered(data, stride, size):
    """Lines of bytes without the filters of the PNG specification, clause 9."""
    lines, previous = [], bytes(stride)
    for start in range(0, len(data), stride + 1):
        kind, line = data[start], bytearray(data[start + 1:start + 1 + stride])
        for i in range(stride):
            a, b, c = line[i - size] if i >= size else 0, previous[i], previous[i - size] if i >= size else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        lines.append(line)
        previous = line
    return lines


def read(file):
    """The Picture of a PNG file; gray becomes colour, alpha is left out."""
    content = file.read_bytes()
    at, data = 8, b""
    while at < len(content):
        length, kind = struct.unpack(">I4s", content[at:at + 8])
        chunk = content[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, _, bits, colour, _, _, interlaced = struct.unpack(">IIBBBBB", chunk)
            if bits != 8 or interlaced or colour not in CHANNELS:
                raise SystemExit(f"{file}: not 8 bits a channel, or interlaced, or with a palette")
        elif kind == b"IDAT":
            data += chunk
        at += 12 + length
    size = CHANNELS[colour]
    lines = _unfiltered(zlib.decompress(data), width * size, size)
    return Picture([[tuple(line[i:i + 3]) if size >= 3 else (line[i],) * 3 for i in range(0, width * size, size)]
                    for line in lines])


def png_of(width, height, lines, level=9):
    """The bytes of a PNG file of lines of RGB, each with its filter before it. level: of zlib."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines, level)) + chunk(b"IEND", b""))


def encoded(picture):
    """The bytes of a PNG file."""
    lines = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in picture.rows)
    return png_of(picture.width, picture.height, lines)
