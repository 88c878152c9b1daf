"""Cloth simulation with audited contact. Scenes come from numpy arrays or scene files.

Units are metres, seconds and kilograms; Y is up."""

from __future__ import annotations

from ._selvedge import (
    Error,
    Scene,
    __version__ as __version__,
    check,
    compare,
    contours,
    dataset,
    distance,
    fit,
    plan,
    read_cache,
    read_surfaces,
    step,
    train,
    untangle,
)
from .alembic import AlembicMesh, export_alembic, read_alembic, write_alembic
from .runs import Page, export, simulate, view
from .steppers import SceneArrays, StepDrive, Stepper, StepStart
from .trajectories import RecordedForces, RecordedObstacle, Trajectory, read_trajectory

__all__ = [
    "AlembicMesh",
    "Error",
    "Page",
    "RecordedForces",
    "RecordedObstacle",
    "Scene",
    "SceneArrays",
    "StepDrive",
    "StepStart",
    "Stepper",
    "Trajectory",
    "check",
    "compare",
    "contours",
    "dataset",
    "distance",
    "export",
    "export_alembic",
    "fit",
    "plan",
    "read_alembic",
    "read_cache",
    "read_surfaces",
    "read_trajectory",
    "simulate",
    "step",
    "train",
    "untangle",
    "view",
    "write_alembic",
]
