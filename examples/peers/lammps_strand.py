"""The strand of strand.toml in LAMMPS: one timed run, as a line of JSON on standard output.

The particles come from the file that `examples/peers/main.rs --particles` writes, so both engines have the same
centres, radii, masses and bonds. Run it under `mpiexec -n N` for N cores; compare.sh does.
"""

import argparse
import json
import resource
import sys
import time
from math import exp, pi, sqrt

import numpy as np
from lammps import LMP_SIZE_ROWS, LMP_STYLE_LOCAL, LMP_TYPE_ARRAY, lammps
from mpi4py import MPI

# The material and the damping of strand.toml, SI.
YOUNG, POISSON, FRICTION = 110e9, 0.34, 0.2
BOND_DAMPING, CONTACT_DAMPING = 0.02, 0.1
SPEED = 1.0
# Share of a diameter by which LAMMPS lists pairs beyond touch; 0.02 to 0.2 take it as long here, to the noise.
SKIN = 0.05


def read_particles(path):
    with open(path) as file:
        names = file.readline().strip().split(",")
        table = np.loadtxt(file, delimiter=",")
    return dict(zip(names, table.T))


def sections(radius):
    """Area, second moment and polar moment of a round wire [m², m⁴, m⁴]."""
    return pi * radius**2, pi * radius**4 / 4, pi * radius**4 / 2


def stiffness(length, radius):
    """Axial, shear (Timoshenko), torsion and bending stiffness of a bond."""
    shear_modulus = YOUNG / (2 * (1 + POISSON))
    area, inertia, polar = sections(radius)
    kappa = 6 * (1 + POISSON) / (7 + 6 * POISSON)
    phi = 12 * YOUNG * inertia / (kappa * shear_modulus * area * length**2)
    return (
        YOUNG * area / length,
        12 * YOUNG * inertia / (length**3 * (1 + phi)),
        shear_modulus * polar / length,
        YOUNG * inertia / length,
    )


def write_data(path, p):
    """A data file with one bond type per layer, whose bonds all have one length."""
    n = len(p["x"])
    bonded = np.flatnonzero(p["rest_length"] > 0)
    density = p["mass"] / (4 / 3 * pi * p["radius"] ** 3)
    margin = 3e-3
    low, high = p["z"].min() - margin, p["z"].max() + 2 * margin
    with open(path, "w") as file:
        file.write(f"strand\n\n{n} atoms\n{len(bonded)} bonds\n1 atom types\n{int(p['layer'].max()) + 1} bond types\n")
        file.write("2 extra bond per atom\n4 extra special per atom\n\n")
        file.write(f"{-margin} {margin} xlo xhi\n{-margin} {margin} ylo yhi\n{low} {high} zlo zhi\n")
        file.write("\nAtoms # bpm/sphere\n\n")
        for i in range(n):
            numbers = [2 * p["radius"][i], density[i], p["x"][i], p["y"][i], p["z"][i]]
            file.write(f"{i + 1} {int(p['wire'][i]) + 1} 1 " + " ".join(repr(float(v)) for v in numbers) + "\n")
        file.write("\nBonds\n\n")
        for k, i in enumerate(bonded):
            file.write(f"{k + 1} {int(p['layer'][i]) + 1} {i + 1} {i + 2}\n")
    return len(bonded)


def bond_commands(style, p):
    """Bonds that never break, with the stiffness and the damping of ours where the style has that mode."""
    unbreakable = 1e9
    lines = []
    for layer in range(int(p["layer"].max()) + 1):
        inside = np.flatnonzero((p["layer"] == layer) & (p["rest_length"] > 0))[1]
        length, radius, mass = (float(p[name][inside]) for name in ("rest_length", "radius", "mass"))
        k = stiffness(length, radius)
        reduced = [mass / 2, mass / 2] + [0.4 * mass * radius**2 / 2] * 2
        damping = [2 * BOND_DAMPING * sqrt(k * m) for k, m in zip(k, reduced)]
        if style == "bpm/rotational":
            numbers = [*k, *[unbreakable] * 4, *damping]
        else:
            # Breaks at 20 % and yields at 20 %: neither happens here.
            numbers = [k[0], 0.2, damping[0], 0.2]
        lines.append(f"bond_coeff {layer + 1} " + " ".join(f"{v:.12g}" for v in numbers))
    return [f"bond_style {style} overlay/pair no", *lines]


def groups(p):
    """The two grips by runs of particle numbers."""
    lines = []
    for name, hold in (("low", 1), ("high", 2)):
        ids = np.flatnonzero(p["hold"] == hold) + 1
        runs = np.split(ids, np.flatnonzero(np.diff(ids) > 1) + 1)
        for some in range(0, len(runs), 10):
            lines.append(f"group {name} id " + " ".join(f"{run[0]}:{run[-1]}" for run in runs[some : some + 10]))
    return [*lines, "group held union low high"]


def setup(data, style, dt, p):
    # The restitution of a linear spring with our damping.
    restitution = exp(-pi * CONTACT_DAMPING / sqrt(1 - CONTACT_DAMPING**2))
    diameter = 2 * float(p["radius"].max())
    return [
        "units si",
        "atom_style bpm/sphere",
        "atom_modify map array",
        "newton on off",
        "processors 1 1 *",
        "boundary f f f",
        f"comm_modify vel yes cutoff {2.3 * diameter}",
        "special_bonds lj 0 1 1 coul 1 1 1",
        f"read_data {data}",
        *bond_commands(style, p),
        "pair_style granular",
        f"pair_coeff * * hertz/material {YOUNG} {restitution} {POISSON} "
        f"tangential mindlin NULL 1.0 {FRICTION} damping tsuji",
        f"neighbor {SKIN * diameter} bin",
        "neigh_modify every 1 delay 0 check yes",
        *groups(p),
        # Particles in one grip never move against each other; we leave such pairs out as well.
        "neigh_modify exclude group low low",
        "neigh_modify exclude group high high",
        "fix move all nve/bpm/sphere",
        "fix hold held freeze",
        f"velocity high set 0 0 {SPEED}",
        f"timestep {dt}",
        "compute touching all property/local patom1 patom2 cutoff radius",
        "thermo_style custom step bonds ke",
        "thermo 1000000",
    ]


def closed_contacts(engine, ranks):
    """Pairs that touch, without the bonded ones, which the style lists but gives no contact force."""
    count = engine.extract_compute("touching", LMP_STYLE_LOCAL, LMP_SIZE_ROWS)
    pairs = engine.numpy.extract_compute("touching", LMP_STYLE_LOCAL, LMP_TYPE_ARRAY) if count else np.zeros((0, 2))
    return ranks.allreduce(int(np.sum(np.abs(pairs[:, 0] - pairs[:, 1]) != 1)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("particles")
    parser.add_argument("--bonds", default="bpm/rotational", choices=["bpm/rotational", "bpm/spring/plastic"])
    parser.add_argument("--warm-up", type=int, default=20)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--step", type=float, default=2e-8, help="time step [s]")
    args = parser.parse_args()

    ranks = MPI.COMM_WORLD
    particles = read_particles(args.particles)
    data = f"{args.particles}.{args.bonds.replace('/', '-')}.{ranks.size}.data"
    if ranks.rank == 0:
        write_data(data, particles)
    ranks.Barrier()

    engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
    engine.commands_list(setup(data, args.bonds, args.step, particles))
    engine.command("run 0")
    before = closed_contacts(engine, ranks)
    engine.command(f"run {args.warm_up}")
    ranks.Barrier()
    clock, cpu = time.perf_counter(), time.process_time()
    engine.command(f"run {args.steps} pre no post no")
    ranks.Barrier()
    seconds = time.perf_counter() - clock
    cpu_seconds = ranks.allreduce(time.process_time() - cpu)
    memory = ranks.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    engine.command("run 0")
    bonds, kinetic = engine.get_thermo("bonds"), engine.get_thermo("ke")
    after = closed_contacts(engine, ranks)
    if ranks.rank == 0:
        outcome = {
            "engine": f"LAMMPS {args.bonds}",
            "cores": ranks.size,
            "particles": engine.get_natoms(),
            "bonds": int(bonds),
            "contacts": [before, after],
            "ms_per_step": seconds * 1e3 / args.steps,
            "cpu_ms_per_step": cpu_seconds * 1e3 / args.steps,
            "time": (args.warm_up + args.steps) * args.step,
            "kinetic": kinetic,
            "memory": memory * 1024e-6,
            "version": engine.version(),
        }
        json.dump(outcome, sys.stdout)
        print()


if __name__ == "__main__":
    main()
