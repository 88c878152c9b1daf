"""Stand-ins in the layout of files that may not be handed out: a body as SMPL-X has it, and a motion as AMASS has it.

smplx.py makes shirt.obj, SMPLX_TEST.npz and motion_test.npz in the working folder. The surface is the program's own
mannequin. Fingers and face have joints, and no vertices. Of the shapes the first makes the body taller, the second
wider; pose directions and expressions are zero.
"""

import numpy as np
from figure import joints, make_surfaces, skin_weights

JOINTS, SHAPES, NEAR = 55, 20, 40
ARMS_DOWN, TURN = np.radians(65), np.radians(25)


def all_joints():
    """Parents and places [m] of SMPL-X's joints: to the body's 22 come jaw and eyes, then five fingers a hand."""
    _, parents, places = joints()
    parents, places = list(parents), list(places)
    for offset in ((0, 0.02, 0.05), (0.03, 0.06, 0.07), (-0.03, 0.06, 0.07)):
        parents.append(15)
        places.append(places[15] + offset)
    for wrist, side in ((20, 1), (21, -1)):
        for finger in range(5):
            for phalanx in range(3):
                parents.append(len(parents) - 1 if phalanx else wrist)
                places.append(places[wrist] + (side * (0.08 + 0.02 * phalanx), 0, 0.02 * (finger - 2)))
    return parents, np.array(places)


def regressor(x, places):
    """j x n: each joint as a combination of the vertices nearest to it, which sums to 1."""
    rows = np.zeros((len(places), len(x)))
    for row, place in zip(rows, places):
        near = np.argsort(np.linalg.norm(x - place, axis=1))[:NEAR]
        row[near] = np.linalg.lstsq(np.vstack([x[near].T, np.ones(NEAR)]), np.append(place, 1), rcond=None)[0]
    return rows


def write_body(file, x, triangles):
    parents, places = all_joints()
    weights = np.zeros((len(x), JOINTS))
    weights[:, :22] = skin_weights(x, parents[:22], places[:22])
    shapes = np.zeros((len(x), 3, SHAPES))
    shapes[:, :, 0], shapes[:, :, 1] = 0.035 * x, x * (0.02, 0, 0.08)
    np.savez_compressed(
        file,
        v_template=x,
        f=triangles.astype(np.uint32),
        shapedirs=shapes,
        posedirs=np.zeros((len(x), 3, 9 * (JOINTS - 1)), np.float32),
        J_regressor=regressor(x, places),
        weights=weights,
        kintree_table=np.array([parents, range(JOINTS)]).astype(np.uint32),
    )


def write_motion(file, frames=60, fps=30):
    """The arms come down, and the chest turns to one side and back. Z is up, as in AMASS."""
    body, turn = np.zeros((frames, 21, 3)), np.linspace(0, 2 * np.pi, frames)
    down = ARMS_DOWN * np.clip(np.arange(frames) / 30, 0, 1)
    body[:, 15, 2], body[:, 16, 2] = -down, down
    body[:, 8, 1] = TURN * np.sin(turn)
    np.savez(
        file,
        root_orient=np.tile((np.pi / 2, 0, 0), (frames, 1)),
        pose_body=body.reshape(frames, 63),
        pose_jaw=np.zeros((frames, 3)),
        pose_eye=np.zeros((frames, 6)),
        pose_hand=np.zeros((frames, 90)),
        trans=np.tile((0, 0, 0.94), (frames, 1)),
        betas=np.zeros(10),
        mocap_frame_rate=float(fps),
        mocap_time_length=frames / fps,
    )


write_body("SMPLX_TEST.npz", *make_surfaces())
write_motion("motion_test.npz")
