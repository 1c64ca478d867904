"""What a closed-form scene must look like: mean radiance of rectangles of pixels under a box filter."""

import json
import math

# Gauss-Legendre on [0, 1], exact to degree 5: within a pixel the closed forms are as good as quadratic.
_NODES = (0.5 - math.sqrt(0.15), 0.5, 0.5 + math.sqrt(0.15))
_WEIGHTS = (5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0)


class Expectation:
    """radiance(direction) -> rgb is the closed form for a ray that leaves the camera in that direction.

    sampled, gathered: iterations and light paths an iteration by which --direct it is rendered.
    """

    def __init__(self, formula, camera, radiance, sampled, gathered, tolerance=0.005):
        self._camera, self._radiance = camera, radiance
        budgets = {way: {"iterations": iterations, "photons": photons}
                   for way, (iterations, photons) in (("sampled", sampled), ("gathered", gathered))}
        self._settings = {"formula": formula, "size": list(camera.size), **budgets, "tolerance": tolerance}
        self._regions = []

    def add_region(self, name, x, y):
        """Pixels x[0] <= px < x[1], y[0] <= py < y[1]."""
        total = [0.0, 0.0, 0.0]
        for py in range(*y):
            for px in range(*x):
                for ny, wy in zip(_NODES, _WEIGHTS):
                    for nx, wx in zip(_NODES, _WEIGHTS):
                        value = self._radiance(self._camera.ray(px + nx, py + ny))
                        total = [t + wx * wy * v for t, v in zip(total, value)]
        pixels = (x[1] - x[0]) * (y[1] - y[0])
        rgb = [float(f"{t / pixels:.7g}") for t in total]
        self._regions.append({"name": name, "x": list(x), "y": list(y), "rgb": rgb})

    def text(self, scene):
        """The file's text; `scene` is the name of the glTF file beside it."""
        lines = [f"  {json.dumps(key)}: {json.dumps(value)}," for key, value in
                 {"scene": scene, **self._settings}.items()]
        regions = ",\n".join(f"    {json.dumps(region)}" for region in self._regions)
        return "{\n" + "\n".join(lines) + '\n  "regions": [\n' + regions + "\n  ]\n}\n"
