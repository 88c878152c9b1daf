"""Cloth simulation with audited contact: scenes from numpy arrays or scene files."""

from ._selvedge import Error, Scene, check, read_trajectory, untangle

__all__ = ["Error", "Scene", "check", "read_trajectory", "simulate", "untangle"]


def simulate(scene, frames=None, callback=None):
    """Steps to that frame (the scene file's by default), or until a step is rejected or the callback, which is called
    with the scene after every frame, returns False. Returns the frame that was reached."""
    frames = scene.frames if frames is None else frames
    while scene.frame < frames and scene.step():
        if callback is not None and callback(scene) is False:
            break
    return scene.frame
