"""What 256 flights of TARGET reference case 2 cost in heyoka, a Taylor integrator that compiles the equations when it runs, in batch mode.

`python taylor.py REENTRY`, with heyoka 7 and NumPy installed and the program. The flights differ in speed, mass and density. heyoka is given the
known time of each impact, which `reentry` has to find; the misses are those from flights at a tolerance of 1e-13.
"""

import itertools
import json
import math
import subprocess
import sys
import time
from pathlib import Path

import heyoka as hy
import numpy as np

RADIUS, GRAVITY, ROTATION = 6378137.0, 9.798, 7.2921151467e-5
DENSITY, SCALE_HEIGHT = 1.54793, 6935.0
MEMBERS = 256
CASE = json.loads((Path(__file__).parents[2] / "openapi/examples/target_2.json").read_text())


def part(member, number):
    return (member * (2 * number + 7) * 37) % 101 / 101 - 0.5


def cases(tolerance):
    for member in range(MEMBERS):
        state, vehicle = CASE["initial_state"], CASE["vehicle"]
        yield CASE | {
            "initial_state": state | {"speed": state["speed"] * (1 + 2e-3 * part(member, 1))},
            "vehicle": vehicle | {"mass": vehicle["mass"] * (1 + 0.1 * part(member, 2))},
            "density_factor": 1 + 0.2 * part(member, 3),
            "solver": {"relative_tolerance": tolerance},
            "output": {"trajectory": False},
        }


def ends(reentry, tolerance):
    """Times, s, and positions, m, of the impacts."""
    text = json.dumps(list(cases(tolerance)))
    lines = subprocess.run([reentry, "simulate", "-"], input=text, capture_output=True, text=True, check=True).stdout
    final = [json.loads(line)["final_state"] for line in lines.splitlines()]
    return [end["time"] for end in final], [place(end) for end in final]


def place(state):
    latitude, longitude = state["geocentric_latitude"], state["longitude"]
    level = math.cos(latitude)
    return state["radius"] * np.array([level * math.cos(longitude), level * math.sin(longitude), math.sin(latitude)])


def start(state):
    up = place(state | {"radius": 1.0})
    east = np.array([-math.sin(state["longitude"]), math.cos(state["longitude"]), 0.0])
    north = np.cross(up, east)
    angle, heading = state["flight_path_angle"], state["heading"]
    level = math.cos(heading) * east + math.sin(heading) * north
    velocity = state["speed"] * (math.sin(angle) * up + math.cos(angle) * level)
    return np.concatenate([place(state) / RADIUS, velocity / SPEED])


# The equations are in units of the radius and the circular speed.
SPEED = math.sqrt(GRAVITY * RADIUS)
TIME = RADIUS / SPEED


def equations():
    position, velocity = hy.make_vars("x", "y", "z"), hy.make_vars("u", "v", "w")
    dot = lambda one, other: hy.sum([a * b for a, b in zip(one, other)])
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    radius, speed = hy.sqrt(dot(position, position)), hy.sqrt(dot(velocity, velocity))
    up, ahead = [a / radius for a in position], [a / speed for a in velocity]
    left = cross(up, ahead)
    cosine = hy.sqrt(dot(left, left))
    climb = dot(up, ahead)
    # The parameters are the acceleration of drag and of lift under a unit of ρ V², at the ground.
    pressure = hy.exp((1.0 - radius) * (RADIUS / SCALE_HEIGHT)) * speed * speed
    drag, lift = hy.par[0] * pressure, hy.par[1] * pressure / cosine
    bank = CASE["control"]["bank_angle"]
    lift_up, lift_left = lift * math.cos(bank), lift * math.sin(bank)
    turn = ROTATION * TIME
    fall = [
        2.0 * turn * velocity[1] + turn * turn * position[0],
        -2.0 * turn * velocity[0] + turn * turn * position[1],
        0.0,
    ]
    acceleration = [
        (up[i] - ahead[i] * climb) * lift_up + left[i] * lift_left - ahead[i] * drag - up[i] / (radius * radius) + fall[i]
        for i in range(3)
    ]
    return list(zip(position, velocity)) + list(zip(velocity, acceleration))


def main(reentry):
    times, exact = ends(reentry, 1e-13)
    states = np.array([start(case["initial_state"]) for case in cases(1e-13)])
    aerodynamics = CASE["vehicle"]["aerodynamics"]
    parameters = np.array([
        [0.5 * case["density_factor"] * DENSITY * CASE["vehicle"]["reference_area"] / case["vehicle"]["mass"] * RADIUS
         * aerodynamics[name] for name in ("drag_coefficient", "lift_coefficient")]
        for case in cases(1e-13)
    ])
    until = np.array(times) / TIME
    print(f"| heyoka {hy.__version__}, batches of | tolerance | greatest miss | time of a flight |")
    print("| --- | --- | --- | --- |")
    sizes = (hy.recommended_simd_size(), 2 * hy.recommended_simd_size())
    for size, tolerance in itertools.product(sizes, (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12)):
        integrator = hy.taylor_adaptive_batch(
            equations(), np.ascontiguousarray(states[:size].T), tol=tolerance, pars=np.ascontiguousarray(parameters[:size].T)
        )
        least, miss = math.inf, 0.0
        for _ in range(20):
            begin = time.perf_counter()
            found = []
            for first in range(0, MEMBERS, size):
                integrator.set_time(0.0)
                integrator.state[:] = states[first : first + size].T
                integrator.pars[:] = parameters[first : first + size].T
                integrator.propagate_until(np.ascontiguousarray(until[first : first + size]))
                found.append(integrator.state[:3].T.copy())
            least = min(least, time.perf_counter() - begin)
        miss = max(np.linalg.norm(np.concatenate(found) * RADIUS - exact, axis=1))
        print(f"| {size} | {tolerance:g} | {miss:.1e} m | {least / MEMBERS * 1e6:.1f} µs |")
    for tolerance in (1e-6, 1e-8, 1e-10):
        _, found = ends(reentry, tolerance)
        print(f"reentry at {tolerance:g}: {max(np.linalg.norm(np.array(found) - exact, axis=1)):.1e} m at its own impacts")


if __name__ == "__main__":
    main(sys.argv[1])
