# %% [markdown]
# # A solver on trial, in a notebook
# `pip install foldproof[report]`, then open this file in Jupyter with jupytext, or run it as it is.

# %%
import numpy as np

import foldproof


# %% [markdown]
# A solver is a class: `prepare` takes a scene, `advance` moves it. x [m] and v [m/s] are (N, 3).


# %%
class Springs(foldproof.Solver):
    name, version, level, precision = "springs", "1.0", "L1", "f8"
    scheme, order = "symplectic Euler", 1
    capabilities = ("set_state", "held", "masses")

    def prepare(self, scene: foldproof.Scene) -> dict[str, str]:
        if scene.header["scene"]["material"]["bending_rigidity"] > 0:
            raise foldproof.Declined("bending")
        self.x, self.v, self.scene = scene.x, scene.v, scene
        return {"stretch": "a spring per edge, of the edge's own stiffness [N/m]"}

    def advance(self, dt: float, steps: int) -> None:
        scene, (i, j) = self.scene, self.scene.edges.T
        for _ in range(steps):
            d = self.x[j] - self.x[i]
            length = np.linalg.norm(d, axis=1)
            pull = (scene.edge_stiffness * (1 - scene.rest_lengths / length))[:, None] * d  # [N]
            f = scene.mass[:, None] * scene.header["scene"]["gravity"]
            np.add.at(f, i, pull)
            np.add.at(f, j, -pull)
            self.v = self.v + dt * f / scene.mass[:, None]
            self.v[scene.held] = 0
            self.x = self.x + dt * self.v


# %%
table = foldproof.judge(Springs, ["smoke", "gravity", "order", "contact"], out="springs")
print(table.outcome.value_counts().to_string())
print(table.loc[table.outcome == "holds", ["measured", "bound", "unit"]])

# %% [markdown]
# The error against the seconds that it takes, and what the file keeps.

# %%
figures = foldproof.plot("springs")
print(list(figures))
run = foldproof.read("springs")
print(run.provenance["subject"], len(run.findings))

# %% [markdown]
# A shipped case, simulated by the reference.

# %%
assert "hanging_sheet" in foldproof.cases()
foldproof.run("simulate", "hanging_sheet", "--set", "time.end=0.1", "--out", "mine")
sheet = foldproof.read("mine/hanging_sheet.h5")
print(sheet.positions.shape, sheet.times[-1])
print(list(foldproof.plot("mine/hanging_sheet.h5", "energies")))
