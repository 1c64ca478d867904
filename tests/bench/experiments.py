"""What the scripts of the paper's experiments share: their options, races that are run once, sections of results/.

The paper: Lin et al., "CPPM: Chi-squared Progressive Photon Mapping", ACM Transactions on Graphics 39(6), 2020, and its
supplementary material. A race that has been run stays under out/experiments, in a folder named after the scene and a
hash of the program, the scene, the reference and all options, and is not run again while those are the same.
"""

import argparse
import hashlib
import itertools
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
RACES = ROOT / "out" / "experiments"
RESULTS = ROOT / "tests" / "bench" / "results"  # a file a question
SCENES = ("box", "clocks", "conference", "cornell", "diamond", "dining", "glass", "sibenik", "sponza", "torus", "water")


def parser(description, scenes, estimators, iterations=1000):
    """The options of an experiment; the arguments are its defaults."""
    result = argparse.ArgumentParser(description=description)
    add = result.add_argument
    add("--scenes", default=",".join(scenes), help="names in scenes/, separated by commas (default: %(default)s)")
    add("--estimators", default=",".join(estimators), help="as vkcppm race takes them (default: %(default)s)")
    add("--iterations", type=int, default=iterations, help="default: %(default)s")
    add("--photons", type=int, default=16384,
        help="light paths an iteration (default: %(default)s; the paper's: 65536)")
    add("--size", help="WxH, where it is not that of the references")
    add("--seeds", type=int, default=1, help="repetitions, which give intervals of confidence (default: %(default)s)")
    add("--knn", type=int, help="photons in the starting radius (default: the program's)")
    add("--metric", default="srgb_mse", help="a measure of vkcppm compare --json (default: %(default)s, the paper's)")
    add("--device", help="as vkcppm takes it")
    add("--references", type=pathlib.Path, default=ROOT / "scenes" / "references",
        help="folder of NAME.exr (default: scenes/references)")
    add("--make-references", metavar="TIME", help="make what is absent there by vkcppm reference, in this time each")
    add("--program", type=pathlib.Path, default=ROOT / "build" / "vkcppm", help="default: build/vkcppm")
    add("--results", type=pathlib.Path, default=RESULTS / "paper.md",
        help="file whose section is written; figures go to the folder figures beside it (default: %(default)s)")
    return result


def flags(**values):
    """--name=value of those that are not None."""
    return [f"--{name}={value}" for name, value in values.items() if value is not None]


def reference_of(options, scene):
    """The reference, made where it is absent and that was asked for."""
    file = options.references / f"{scene}.exr"
    if not file.exists():
        if not options.make_references:
            raise SystemExit(f"no reference {file}: make it by vkcppm reference, or here by --make-references TIME")
        print(f"reference of {scene}", file=sys.stderr)
        file.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([options.program, "reference", ROOT / "scenes" / f"{scene}.gltf", "-o", file, "--half",
                        *flags(time=options.make_references, size=options.size, device=options.device)], check=True)
    return file


def race(options, scene, **changes):
    """Runs a race, unless it has been run: (its race.json as a Race, its folder). changes: options of this race.

    Photons bring all light, and count by the area of the whole disc, as in the paper.
    """
    chosen = argparse.Namespace(**{**vars(options), **changes})
    scene_file, reference = ROOT / "scenes" / f"{scene}.gltf", reference_of(chosen, scene)
    arguments = flags(estimators=chosen.estimators, iterations=chosen.iterations, photons=chosen.photons,
                      size=chosen.size, seeds=chosen.seeds, knn=chosen.knn, device=chosen.device, direct="gathered",
                      disc_area="whole", exposure=getattr(chosen, "exposure", None),
                      seed=getattr(chosen, "seed", None))
    key = hashlib.sha256("\n".join(arguments).encode())
    for file in (chosen.program, scene_file, reference):
        key.update(hashlib.sha256(file.read_bytes()).digest())
    folder = RACES / f"{scene}-{key.hexdigest()[:12]}"
    if not (folder / "race.json").exists():
        print(f"{scene}: {' '.join(arguments)}", file=sys.stderr)
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run([chosen.program, "race", scene_file, *arguments, "--reference", reference, "-o", folder],
                       check=True)
    return Race(json.loads((folder / "race.json").read_text()), chosen.metric), folder


class Race:
    """What a race.json says by one metric, of errors without the noise of the reference.

    A picture and its reference have noise of their own, so squared errors add: the reference tells by its standard
    errors what it adds to a metric, and that is taken off. What is left below a quarter of it is not known.
    """

    def __init__(self, data, metric):
        if data["interrupted"]:
            raise SystemExit("the race was interrupted: delete its folder of out/experiments and run it again")
        self.data = data
        self.entrants = {entrant["name"]: entrant for entrant in data["entrants"]}
        self.metric = metric
        self.title = {m["name"]: m["title"] for m in data["metrics"]}[metric]
        self.noise = float(data["reference"]["attributes"].get(f"vkcppm.{metric}", 0.0))

    def _curves(self, name, axis="iterations"):
        """[[(x, error)]] of every seed, as long as the error is known."""
        curves = []
        for run in self.entrants[name]["runs"]:
            points = [(point[axis], point[self.metric] - self.noise) for point in run["curve"]]
            curves.append(list(itertools.takewhile(lambda p: p[1] > 0.25 * self.noise, points)))
        return curves

    def _over_seeds(self, values):
        """Geometric mean over the seeds and, from two on, the range."""
        return {"mean": geometric_mean(values), "low": min(values) if len(values) > 1 else None,
                "high": max(values) if len(values) > 1 else None}

    def final(self, name):
        """{mean, low, high} of the last error that is known."""
        return self._over_seeds([curve[-1][1] for curve in self._curves(name)])

    def equal(self, name, baseline, axis):
        """{mean, low, high} of the iterations or seconds to the baseline's last error, interpolated log-log; None where
        not all seeds come down to it."""
        found = []
        for curve, target in zip(self._curves(name, axis), self._curves(baseline, axis)):
            level = target[-1][1]
            at = next((i for i, (_, error) in enumerate(curve) if error <= level), None)
            if name == baseline:
                found.append(target[-1][0])
            elif at is None:
                return None
            elif at == 0:
                found.append(curve[0][0])
            else:
                (x0, y0), (x1, y1) = curve[at - 1], curve[at]
                found.append(x0 * (x1 / x0) ** (math.log(y0 / level) / math.log(y0 / y1)))
        return self._over_seeds(found)

    def took(self, name, axis):
        """Mean over the seeds of the iterations, or the seconds on the clock, at the end."""
        runs = self.entrants[name]["runs"]
        return sum(run[axis] for run in runs) / len(runs)

    def curve(self, name, axis="iterations"):
        """[{x, mean, low, high}] of the error."""
        return [{"x": geometric_mean([p[0] for p in points]), **self._over_seeds([p[1] for p in points])}
                for points in zip(*self._curves(name, axis))]

    def slope(self, name, axis="iterations"):
        """Of the curve's last factor of ten, log-log, by least squares, as text; a dash where there is none."""
        curve = self.curve(name, axis)
        points = [(math.log(p["x"]), math.log(p["mean"])) for p in curve if 10 * p["x"] >= curve[-1]["x"]]
        return f"{statistics.linear_regression(*zip(*points)).slope:.2f}" if len(points) > 1 else "–"

    def colour(self, name):
        return self.entrants[name]["colour"]


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def significant(value, digits=3):
    """A number with so many digits, without an exponent."""
    places = max(0, digits - 1 - math.floor(math.log10(abs(value)))) if value else 0
    return f"{value:.{places}f}"


def table(rows):
    """Markdown of [[cell]], the first row the head."""
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]]) + "\n"


def paragraph(text):
    """Markdown of lines of 120 columns, an empty one behind."""
    return textwrap.fill(" ".join(text.split()), 120, break_long_words=False, break_on_hyphens=False) + "\n\n"


def commit():
    """The commit of the working tree, with -dirty where it is changed."""
    return subprocess.run(["git", "describe", "--always", "--dirty"], cwd=ROOT, check=True, stdout=subprocess.PIPE,
                          text=True).stdout.strip()


def conditions(options, some_race):
    """What figures hold for, a paragraph; all but the scene is the same for all races of an experiment."""
    data = some_race.data
    settings = data["entrants"][0]["settings"]
    noise = f" ({some_race.noise:.3g} in {pathlib.Path(data['scene']['file']).stem})" if some_race.noise else ""
    return paragraph(f"""Commit: {commit()}. Device: {data['driver']}. {data['width']}x{data['height']} pixels,
        {settings['photons']:,} paths an iteration, {data['iterations']:,} iterations, k_NN = {settings['knn']},
        {options.seeds} {'seed' if options.seeds == 1 else 'seeds'}. Error: {some_race.title}, against the scenes'
        references, whose own noise is taken off{noise}. Seconds are those of the passes, by the device's timestamps;
        estimators take turns.""")


def write_figure(options, name, text):
    """Writes figures/NAME beside the results; returns how Markdown shows it. text: str or bytes."""
    file = options.results.parent / "figures" / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return f"figures/{name}"


def write_section(options, name, title, text):
    """Replaces what stands between the script's markers; a section that is not there yet is added at the end."""
    begin, end = f"<!-- tests/bench/{name}: begin -->\n", f"<!-- tests/bench/{name}: end -->\n"
    results = options.results.read_text(encoding="utf-8") if options.results.exists() else "# Results of benchmarks\n"
    if begin not in results:
        results += f"\n## {title}\n\n    tests/bench/{name}\n\n{begin}{end}"
    before, rest = results.split(begin)
    options.results.write_text(before + begin + text + end + rest.split(end)[1], encoding="utf-8")
    print(f"wrote {os.path.relpath(options.results)}", file=sys.stderr)
