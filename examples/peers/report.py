"""Tables from the runs of compare.sh; fails when the engines did not compute the same strand."""

import json
import sys
from math import cos, atan, pi, sqrt
from statistics import median

OURS, FULL = "strandsnap", "strandsnap, full physics"
ROTATIONAL, SPRING = "LAMMPS bpm/rotational", "LAMMPS bpm/spring/plastic"

CAN = {
    OURS: "bonds in all modes, elastic; energy ledger",
    FULL: "the same, and bonds that yield and break one by one, Thornton contacts",
    ROTATIONAL: "bonds in all modes, elastic; no plastic bending, no Thornton contacts, no ledger of bonds",
    SPRING: "bonds that only stretch: no shear, bending or twist, so wires have no bending stiffness",
}

# Wall milliseconds per step on 1 and on 2 cores, measured earlier on an idle machine, not in this run: the same strand
# with spheres at one diameter, 10.6 thousand of them, 1,588 contacts closed, step 2e-8 s, no output.
MARKS = {
    "LIGGGHTS, flexible fibres": ((1.26, 0.92), "elastic bonds in all modes"),
    "LAMMPS bpm/rotational": ((2.8, 1.5), "elastic bonds in all modes"),
    "Yade 2023.02, CohFrict moments": ((5.0, 4.0), "bonds in all modes, linear contacts"),
}

# Greatest relative differences of kinetic energy: between engines, and from the closed form of straight wires that do
# not touch (dispersion of the chain and friction between wires are not in it).
BETWEEN, FROM_CLOSED_FORM = 0.02, 0.05


def closed_form(time):
    """Kinetic energy of the wave that a grip sends along the wires when it starts at 1 m/s [J].

    Behind the front, which runs along each wire at √(E/ρ), all moves with the grip: ½ ρA v² over that length.
    """
    density, young, area, pitch, grip = 8960.0, 110e9, pi * 0.195e-3**2, 39e-3, 2e-3
    speed = sqrt(young / density)
    length = 0.0
    for wires, radius in ((5, 0.3316e-3), (11, 0.7205e-3), (18, 1.1255e-3)):
        length += wires * (speed * time + grip / cos(atan(2 * pi * radius / pitch)))
    return 0.5 * density * area * length


def read(path):
    groups = {}
    with open(path) as file:
        for line in file:
            run = json.loads(line)
            groups.setdefault((run["engine"], run["cores"]), []).append(run)
    return groups


def best(groups, engine, cores, what="ms_per_step"):
    return min(run[what] for run in groups[engine, cores])


def print_times(groups):
    print("\nms per step, best and median of the repeats, and how many times strandsnap's elastic run; the same for")
    print("processor time over all cores, which says more than wall time where others use the machine")
    print(f"{'':26} cores    best  median   ratio | processor   ratio | memory MB")
    for (engine, cores), runs in sorted(groups.items(), key=lambda item: item[0][1]):
        wall, cpu = best(groups, engine, cores), best(groups, engine, cores, "cpu_ms_per_step")
        ratio = wall / best(groups, OURS, cores)
        cpu_ratio = cpu / best(groups, OURS, cores, "cpu_ms_per_step")
        print(
            f"{engine:26} {cores:5} {wall:7.3f} {median(run['ms_per_step'] for run in runs):7.3f} {ratio:6.2f}× |"
            f" {cpu:9.3f} {cpu_ratio:6.2f}× | {max(run['memory'] for run in runs):9.0f}"
        )
    print()
    for engine, what in CAN.items():
        print(f"{engine:26} {what}")


def print_marks(groups):
    print("\nMeasured EARLIER on an idle machine, not in this run: ms per step, and how many times ours of this run")
    all_cores = sorted({cores for _, cores in groups})
    for name, (marks, what) in MARKS.items():
        cells = []
        for cores, mark in zip((1, 2), marks):
            if cores in all_cores:
                ratio = mark / best(groups, OURS, cores)
                cells.append(f"{cores} core{'s' * (cores > 1)} {mark:5.2f} ({ratio:4.1f}×)")
        print(f"{name:32} {', '.join(cells)}; {what}")


def print_checks(groups):
    """What the engines computed; the differences that must not be."""
    wrong = []
    reference = groups[OURS, 1][0]
    expected = closed_form(reference["time"])
    print(f"\nThe same strand? Kinetic energy at {reference['time'] * 1e6:.2f} µs; closed form {expected:.4e} J")
    print(f"{'':28} {'cores':>5} {'particles':>9} {'bonds':>7} {'closed at start':>15} {'at end':>7} {'kinetic J':>11}")
    for (engine, cores), runs in sorted(groups.items(), key=lambda item: item[0][1]):
        run = runs[0]
        start, end = run["contacts"]
        print(
            f"{engine:28} {cores:5} {run['particles']:9} {run['bonds']:7} {start:15} {end:7} {run['kinetic']:11.4e}"
        )
        for what in ("particles", "bonds"):
            if run[what] != reference[what]:
                wrong.append(f"{engine} has {run[what]} {what}, not {reference[what]}")
        if start != reference["contacts"][0]:
            wrong.append(f"{engine} starts with {start} closed contacts, not {reference['contacts'][0]}")
        if any(other["kinetic"] != run["kinetic"] for other in runs):
            wrong.append(f"{engine} on {cores} cores differs from repeat to repeat")
        # Yielding wires carry a slower wave: only elastic runs have the closed form.
        if engine != FULL and abs(run["kinetic"] / expected - 1) > FROM_CLOSED_FORM:
            wrong.append(f"{engine}: kinetic energy {run['kinetic']:.4e} J is far from the closed form")
        if engine != FULL and abs(run["kinetic"] / reference["kinetic"] - 1) > BETWEEN:
            wrong.append(f"{engine}: kinetic energy {run['kinetic']:.4e} J is not ours, {reference['kinetic']:.4e} J")
    return wrong


def main():
    groups = read(sys.argv[1])
    wrong = print_checks(groups)
    if wrong:
        sys.exit("NOT THE SAME COMPUTATION, so times say nothing:\n  " + "\n  ".join(wrong))
    print("the same particles, bonds and closed contacts, and the same motion")
    print_times(groups)
    print_marks(groups)
    print(
        "\nNone of the others has Thornton contacts together with plastic bending bonds, stress per wire and per layer,\n"
        "an energy ledger of bonds, or scattered rupture."
    )


if __name__ == "__main__":
    main()
