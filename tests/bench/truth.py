"""What pixels of a small picture should be: means over many pixels of a reference. Needs numpy and OpenEXR."""

import math

import numpy
import OpenEXR

import experiments as ex

EPSILON = 0.01  # of relMSE
TRIMMED_ONE_IN = 1000


def read(file):
    """(channels [height x width] by name, the attributes of vkcppm)."""
    with OpenEXR.File(str(file), separate_channels=True) as exr:
        header = {key.removeprefix("vkcppm."): value for key, value in exr.header().items()
                  if key.startswith("vkcppm.")}
        return {name: numpy.array(c.pixels, dtype=float) for name, c in exr.channels().items()}, header


def colour_of(channels):
    """[height x width x 3]"""
    return numpy.stack([channels[c] for c in "RGB"], -1)


def blocks(values, side):
    """Means over blocks of side x side pixels."""
    height, width = values.shape
    return values.reshape(height // side, side, width // side, side).mean((1, 3))


def truth(scene, options):
    """(colour [height x width x 3], its standard error [height x width]) of the small picture: options.shrink pixels of
    the reference a side of a pixel, at most."""
    channels, _ = read(ex.reference_of(options, scene))
    side = math.gcd(*channels["R"].shape)
    side = max(s for s in range(1, options.shrink + 1) if side % s == 0)
    colour = numpy.stack([blocks(channels[c], side) for c in "RGB"], -1)
    # As if the errors of the pixels of a block were independent: photons make them less so.
    return colour, numpy.sqrt(blocks(channels["StdErr"] ** 2, side)) / side


def stated_squares(reference, stated):
    """[height x width x 3] What the reference adds to the squared errors of channels. It states the mean over them:
    alike beside their light, which comes to the relMSE that it states of itself; alike in themselves, a coloured
    surface would have nearly all of it in the channel of which it shows least."""
    squares = reference ** 2
    share = squares / numpy.maximum(squares.mean(-1, keepdims=True), 1e-30)
    return stated[..., None] ** 2 * share


def squares_of(colour, reference, stated):
    """[pixels] of relMSE, less what the reference adds."""
    weight = 1.0 / (reference ** 2 + EPSILON)
    return (((colour - reference) ** 2 - stated_squares(reference, stated)) * weight).mean(-1).ravel()


def without_worst(colour, reference):
    """The pixels without the worst 0.1 %."""
    weight = 1.0 / (reference ** 2 + EPSILON)
    order = numpy.argsort((((colour - reference) ** 2) * weight).mean(-1).ravel())
    return order[:len(order) - len(order) // TRIMMED_ONE_IN]


def errors(colour, reference, stated):
    """relmse and relmse_trimmed of a picture, less what the reference adds."""
    squares = squares_of(colour, reference, stated)
    return squares.mean(), squares[without_worst(colour, reference)].mean()
