"""pcednet in a notebook: from an array to labels, from painted points to a model, from labels to
lines. Each "# %%" begins a cell (Jupyter, VS Code, Spyder); run as a script it does all of them:

    python examples/python/first_steps.py [FOLDER]      # writes into FOLDER, default "out"
"""

# %% Points of any kind: here a generated part whose edges are known
import pathlib
import sys

import numpy as np

import pcednet

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out")
folder.mkdir(exist_ok=True)

part = next(pcednet.generate("lines", only="bracket_0"))
xyz = part.xyz  # (n, 3) float64
print(part)

# %% Label every point
normals = pcednet.estimate_normals(xyz)
result = pcednet.classify(xyz, normals)
print(result)
print("sharp edges: ", pcednet.evaluate(part.labels, result))

# %% Precision and recall at every threshold of the probability
order = np.argsort(-result.p_sharp)
hits = np.cumsum(part.labels[order] == pcednet.SHARP_EDGE)
precision = hits / np.arange(1, len(hits) + 1)
recall = hits / hits[-1]

# %% A definition of one's own: rounded edges are edges like the others. Paint 300 points of each kind
wanted = np.where(part.labels > 0, pcednet.SHARP_EDGE, pcednet.NON_EDGE)
random = np.random.default_rng(1)
painted = {"sharp-edge": random.choice(np.flatnonzero(wanted == 2), 300, replace=False),
           "non-edge": random.choice(np.flatnonzero(wanted == 0), 300, replace=False)}
model = pcednet.train(xyz, painted, normals=normals, start="general", name="mine")
model.save(folder / "mine.safetensors", overwrite=True)

mine = model.classify(xyz, normals)
unseen = wanted.copy()
unseen[np.concatenate(list(painted.values()))] = pcednet.UNLABELLED  # not scored on what was painted
print("my definition, general:", pcednet.evaluate(unseen, result))
print("my definition, mine:   ", pcednet.evaluate(unseen, mine))

# %% Draw it, where matplotlib is installed
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("no matplotlib: nothing is drawn")
else:
    figure, axes = plt.subplots(figsize=(5, 5))
    axes.plot(recall, precision)
    axes.set(xlabel="recall", ylabel="precision", xlim=(0, 1), ylim=(0, 1.02),
             title="sharp edges, model general")
    figure.savefig(folder / "precision_recall.png")

# %% Edges as lines, for CAD
lines = pcednet.lines(xyz, result)
lines.write(folder / "edges.dxf", overwrite=True)
print(lines, "->", folder / "edges.dxf")

# %% The labelled cloud, for CloudCompare and others
pcednet.write(folder / "edges.ply", part, result, overwrite=True)
