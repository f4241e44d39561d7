"""A problem of problems.py in MuJoCo: peer_mujoco.py PROBLEM.json SETTING.json prints its state at the end."""

import json
import sys
import time
from pathlib import Path

import mujoco
import numpy as np


def main():
    problem, setting = (json.loads(Path(path).read_text()) for path in sys.argv[1:3])
    model = mujoco.MjModel.from_xml_string(scene(problem, setting))
    data = mujoco.MjData(model)
    for number, body in enumerate(problem["bodies"]):
        data.qvel[6 * number : 6 * number + 3] = body["velocity_m_s"]
    mujoco.mj_forward(model, data)
    steps, samples = round(problem["end_s"] / setting["step_s"]), problem["samples"]
    energies, cpu_s, wall_s = [energy(model, data)], 0.0, 0.0
    for sample in range(samples):
        count = steps * (sample + 1) // samples - steps * sample // samples
        wall, cpu = time.perf_counter(), time.process_time()
        mujoco.mj_step(model, data, nstep=count)
        wall_s += time.perf_counter() - wall
        cpu_s += time.process_time() - cpu
        energies.append(energy(model, data))
    mujoco.mj_kinematics(model, data)
    bodies = range(1, model.nbody)
    print(
        json.dumps(
            {
                "version": mujoco.__version__,
                "steps": steps,
                "step_cpu_s": cpu_s,
                "step_wall_s": wall_s,
                "energies_j": energies,
                "corners_m": [corners(data, number, body) for number, body in zip(bodies, problem["bodies"])],
                "centres_m": [data.xipos[number].tolist() for number in bodies],
                "velocities_m_s": [data.qvel[6 * n : 6 * n + 3].tolist() for n in range(model.nbody - 1)],
            }
        )
    )


def scene(problem, setting):
    """MJCF; half-spaces for supports where a program may take them.

    `{two_steps}` stands for the stiffest time constant of contact that MuJoCo advises."""
    assets, geoms, bodies = [], [], []
    geom = {name: value.format(two_steps=2 * setting["step_s"]) for name, value in setting["geom"].items()}
    surface = f'friction="{problem["friction"]:.17g} 0 0" condim="{3 if problem["friction"] else 1}" ' + attributes(
        geom
    )
    for support in problem["supports"]:
        if plane := support["plane"]:
            geoms.append(
                f'<geom type="plane" size="0 0 1" pos="{row(plane["point_m"])}" zaxis="{row(plane["normal"])}" {surface}/>'
            )
        else:
            centre, corners = hull(support["corners_m"])
            assets.append(f'<mesh name="{support["name"]}" vertex="{row(corners)}"/>')
            geoms.append(f'<geom type="mesh" mesh="{support["name"]}" pos="{row(centre)}" {surface}/>')
    for body in problem["bodies"]:
        shape = f'type="box" size="{row(body["half_m"])}"' if body["half_m"] else f'type="mesh" mesh="{body["name"]}"'
        if not body["half_m"]:
            assets.append(f'<mesh name="{body["name"]}" inertia="exact" vertex="{row(sum(body["corners_m"], []))}"/>')
        geom = f'<geom {shape} density="{problem["density_kg_m3"]}" {surface}/>'
        bodies.append(f'<body pos="{row(body["centre_m"])}"><freejoint/>{geom}</body>')
    options = f'timestep="{setting["step_s"]}" gravity="{row(problem["gravity_m_s2"])}" {attributes(setting["option"])}'
    # Room for the contacts of a pile.
    return (
        f'<mujoco><option {options}/><size memory="200M"/>'
        f"<asset>{''.join(assets)}</asset><worldbody>{''.join(geoms)}{''.join(bodies)}</worldbody></mujoco>"
    )


def hull(corners):
    """MuJoCo moves a mesh to its own mass centre, so both it and the corners about it are given."""
    centre = np.mean(corners, axis=0)
    return centre, (np.array(corners) - centre).ravel()


def energy(model, data):
    """Kinetic energy and that of the weights [J]."""
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    return float(data.energy.sum())


def corners(data, number, body):
    """A mesh's own frame is that of its inertia, but a body's is what the scene says."""
    turn = data.xmat[number].reshape(3, 3)
    return (data.xpos[number] + np.array(body["corners_m"]) @ turn.T).tolist()


def attributes(values):
    return " ".join(f'{name}="{value}"' for name, value in values.items())


def row(values):
    return " ".join(f"{value:.17g}" for value in values)


if __name__ == "__main__":
    main()
