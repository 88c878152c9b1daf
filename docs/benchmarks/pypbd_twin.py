"""python pypbd_twin.py SCENE.npz RESULT.npz: a pinned sheet by pyPBD's XPBD, 60 substeps of one iteration.

Edges of 1e5 N/m and isometric bending, no contact. With fewer substeps the sheet stretches to several times its length.
"""

import sys
import time

import numpy as np
import pypbd

given = np.load(sys.argv[1])
frames, start = int(given["frames"]), given["x"].astype(float)
side = round(len(start) ** 0.5)
simulation = pypbd.Simulation.getCurrent()
simulation.initDefault()
model = simulation.getModel()
# Its grid is ours but for the order of vertices, which is found by place.
sheet = model.addRegularTriangleModel(side, side, [0, start[0, 1], 0], np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), [1, 1])
particles = model.getParticles()
offset = sheet.getIndexOffset()
there = np.array([particles.getPosition(offset + v) for v in range(side * side)])
there += (start.min(0) + start.max(0)) / 2 - (there.min(0) + there.max(0)) / 2
order = np.array([np.argmin(np.linalg.norm(there - at, axis=1)) for at in start])
assert np.abs(there[order] - start).max() < 1e-4, "its grid is another"
for v in range(side * side):
    particles.setMass(offset + v, 0.2 / side**2)
    particles.setPosition(offset + v, there[v])
    particles.setPosition0(offset + v, there[v])
for pin in given["pins"]:
    particles.setMass(offset + order[pin], 0)
model.addClothConstraints(sheet, 4, 1e5, 1, 1, 1, 0.3, 0.3, False, False)
model.addBendingConstraints(sheet, 3, 50)
step = simulation.getTimeStep()
step.setValueUInt(pypbd.TimeStepController.NUM_SUB_STEPS, 60)
step.setValueUInt(pypbd.TimeStepController.MAX_ITERATIONS, 1)
pypbd.TimeManager.getCurrent().setTimeStepSize(1 / float(given["fps"]))

x, seconds = [start], []
for frame in range(frames):
    began = time.perf_counter()
    step.step(model)
    seconds.append(time.perf_counter() - began)
    x.append(np.array([particles.getPosition(offset + v) for v in range(side * side)])[order])
np.savez(sys.argv[2], x=np.array(x), seconds=np.array(seconds))
