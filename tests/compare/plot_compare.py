#!/usr/bin/env python3
"""Plots of one or several compare.json, as `drape compare` writes them.

  time-against-vertices   set-up and solve against the number of vertices: of the files with sizes, or else of all
  convergence-*           relative residual against iteration, one plot for each system
  work-precision          distance from the reference against wall time, of the integrators' runs

A plot for which the files hold nothing is not made. Needs matplotlib (Debian: python3-matplotlib).
"""

import argparse
import json
import math
import sys
from pathlib import Path

# Okabe & Ito's colours, and a marker for each, so that the plots can be read without colours.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]
MARKERS = "osD^v<>"
ROW_KEYS = {"vertices", "step", "solver", "total_ms", "iterations", "residual", "history"}
RUN_KEYS = {"integrator", "solver", "time_step", "wall_ms", "max_distance", "reference"}


class BadInput(Exception):
    pass


def read(path):
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: is not text") from error
    except json.JSONDecodeError as error:
        raise BadInput(f"{path}:{error.lineno}: is not JSON: {error.msg}") from error
    if not isinstance(data, dict) or not isinstance(data.get("rows"), list):
        raise BadInput(f"{path}: is not a compare.json of drape: it has no 'rows'")
    for kind, keys in (("rows", ROW_KEYS), ("runs", RUN_KEYS)):
        for number, row in enumerate(data.get(kind, [])):
            missing = keys - row.keys() if isinstance(row, dict) else keys
            if missing:
                raise BadInput(f"{path}: {kind}[{number}]: has no '{sorted(missing)[0]}'")
    data["path"] = path
    return data


def names_of(files):
    """How each file is called in a legend: the shortest ends of the paths that tell them apart."""
    parts = [data["path"].parent.parts or (data["path"].name,) for data in files]
    for length in range(1, max(map(len, parts)) + 1):
        names = ["/".join(p[-length:]) for p in parts]
        if len(set(names)) == len(names):
            return names
    return [f"{'/'.join(p)} #{k}" for k, p in enumerate(parts)]


def style(number):
    return {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)], "markersize": 5}


def finish(figure, axes, title, x_label, y_label, path):
    axes.set(title=title, xlabel=x_label, ylabel=y_label)
    axes.grid(True, which="major", alpha=0.35)
    axes.grid(True, which="minor", alpha=0.12)
    axes.legend(fontsize="small")
    figure.tight_layout()
    partial = path.with_name("." + path.name)  # appears only when it is complete
    figure.savefig(partial, format=path.suffix[1:], dpi=150)
    partial.replace(path)
    print(f"wrote {path}")


def plot_time(plt, files, target):
    """Every solver against the sizes: of the last compared step. Files that agree in scene, tolerance and threads make one
    line; scenes are left out as soon as there are sizes, because only the same cloth can be compared."""
    sized = [data for data in files if data.get("sizes")] or files
    lines = {}
    for data in sized:
        steps = {}
        for row in data["rows"]:
            steps[row["vertices"]] = max(steps.get(row["vertices"], 0), row["step"])
        kind = (data.get("scene"), data.get("tolerance"), data.get("threads")) if data.get("sizes") else ()
        for row in data["rows"]:
            if row["step"] == steps[row["vertices"]] and row["total_ms"] > 0:
                lines.setdefault((row["solver"], kind), []).append((row["vertices"], row["total_ms"]))
    if len({vertices for points in lines.values() for vertices, _ in points}) < 2:
        return
    several = len({kind for _, kind in lines}) > 1
    figure, axes = plt.subplots(figsize=(7, 5))
    for number, ((solver, kind), points) in enumerate(lines.items()):
        points.sort()
        label = solver
        if several:
            label += f", {kind[1]:g}, {kind[2]} thread{'' if kind[2] == 1 else 's'}"
        if len({p[0] for p in points}) > 1:
            label += f"  ~ n^{exponent(points):.2f}"
        axes.loglog(*zip(*points), label=label, **style(number))
    finish(figure, axes, "Time against vertices", "vertices n", "set-up and solve, ms", target("time-against-vertices"))
    plt.close(figure)


def exponent(points):
    x = [math.log(p[0]) for p in points]
    y = [math.log(p[1]) for p in points]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def plot_convergence(plt, data, name, target):
    systems = {}
    for row in data["rows"]:
        systems.setdefault((row["vertices"], row["step"]), []).append(row)
    for (vertices, step), rows in systems.items():
        curves = [row for row in rows if len(row["history"]) > 1]
        if not curves:
            continue
        figure, axes = plt.subplots(figsize=(7, 5))
        for number, row in enumerate(curves):
            look = style(number)
            axes.semilogy(row["history"], label=row["solver"], markevery=max(1, len(row["history"]) // 10), **look)
        if data.get("tolerance"):
            axes.axhline(data["tolerance"], color="black", linestyle="--", linewidth=1, label="tolerance asked")
        file = f"convergence-{name}-{vertices}-step-{step}".replace("/", "-")
        finish(figure, axes, f"{name}: convergence at step {step}, {vertices} vertices", "iterations",
               "relative residual", target(file))
        plt.close(figure)


def plot_work_precision(plt, files, names, target):
    series = {}
    for data, name in zip(files, names):
        for run in data.get("runs", []):
            if run["reference"] or not run["max_distance"] or not run["wall_ms"] > 0:
                continue
            linear = run["solver"] != data.get("linear_solver")
            label = "other linear solvers" if linear else run["integrator"]
            if len(files) > 1:
                label = f"{name}: {label}"
            series.setdefault((label, linear), []).append((run["wall_ms"] / 1000, run["max_distance"]))
    if not series:
        return
    figure, axes = plt.subplots(figsize=(7, 5))
    for number, ((label, linear), points) in enumerate(series.items()):
        axes.loglog(*zip(*points), label=label, linestyle="none" if linear else "-", **style(number))
    finish(figure, axes, "Work and precision", "wall time, s", "largest distance from the reference, m",
           target("work-precision"))
    plt.close(figure)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path, metavar="compare.json")
    parser.add_argument("--out", type=Path, default=Path("."), metavar="DIR", help="where the plots go (here)")
    parser.add_argument("--format", choices=("png", "svg"), default="png", help="of the plots (png)")
    return parser.parse_args()


def main():
    options = arguments()
    try:
        import matplotlib
    except ImportError:
        print("error: matplotlib is missing; on Debian or Ubuntu: apt install python3-matplotlib, and run this with "
              "/usr/bin/python3", file=sys.stderr)
        return 2
    matplotlib.use("Agg")  # no screen is needed
    import matplotlib.pyplot as plt
    written = []

    def target(name):
        written.append(name)
        return options.out / f"{name}.{options.format}"

    try:
        files = [read(path) for path in options.files]
        names = names_of(files)
        options.out.mkdir(parents=True, exist_ok=True)
        plot_time(plt, files, target)
        for data, name in zip(files, names):
            plot_convergence(plt, data, name, target)
        plot_work_precision(plt, files, names, target)
    except BadInput as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: {options.out}: {error.strerror}", file=sys.stderr)
        return 2
    if not written:
        print("there is nothing to plot: no sizes, no histories and no integrators in these files")
    return 0


if __name__ == "__main__":
    sys.exit(main())
