# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake: the scene is written, the program runs, its result comes back onto the garments.

`bake(garment)` does all of it, with a window or without. The operators take the same steps a few at a time.
"""

import dataclasses
import shutil

import bpy

from . import audit, reading_back, sampling, writing
from .program import Failure, Run
from .settings import program_path


@dataclasses.dataclass
class Job:
    """A bake at work. Objects go by name, as Blender may make them anew between two steps."""

    garment_name: str
    scene_name: str
    layer_name: str
    resume: bool = False
    stopped: bool = False  # set by whoever wants it to end
    text: str = ""
    fraction: float = 0.0
    waiting: bool = False  # for the program
    run: Run | None = None

    @property
    def garment(self):
        return found_object(self.garment_name)

    @property
    def scene(self):
        return bpy.data.scenes[self.scene_name]


def found_object(name):
    found = bpy.data.objects.get(name)
    if not found:
        raise Failure(f"`{name}` is gone", "bake anew")
    return found


def new_job(context, garment, resume=False):
    return Job(garment.name, context.scene.name, context.view_layer.name, resume)


def bake(garment, resume=False, report=None):
    """Bakes the garment by its settings (`garment.selvedge`) over frames of the present scene, and waits for the end.

    resume: go on where the last bake was stopped. report: is called with a text and a fraction now and then. Returns
    whether the bake has come to its end and is clean; the settings say more. Raises Failure for what is wrong with
    scene, settings or program.
    """
    job = new_job(bpy.context, garment, resume)
    for _ in steps(job):
        if report:
            report(job.text, job.fraction)
        if job.waiting:
            job.run.poll(0.1)
    if job.garment.selvedge.error:
        what, _, cure = job.garment.selvedge.error.partition("\n")
        raise Failure(what, cure)
    return job.garment.selvedge.clean


def steps(job):
    """A generator that bakes: it yields often, after short pieces of work. What is wrong is left in the settings."""
    settings = job.garment.selvedge
    settings.error, settings.message, settings.clean = "", "", False
    settings.warnings.clear()
    try:
        yield from baked(job)
    except (Failure, OSError, ValueError) as why:
        if not isinstance(why, Failure):
            why = Failure(str(why))
        job.garment.selvedge.error = why.what + (f"\n{why.cure}" if why.cure else "")
    finally:
        if job.run:
            job.run.stop()


def frame_span(settings, scene):
    """First frame, step, and number of steps."""
    first, last = scene.frame_start, scene.frame_end
    if not settings.scene_range:
        first, last = settings.frame_start, settings.frame_end
    step = max(1, scene.frame_step)
    if last < first + step:
        raise Failure(f"there is no step of {step} from frame {first} to {last}", "choose other frames")
    return first, step, (last - first) // step


def baked(job):
    garment, scene = job.garment, job.scene
    layer = scene.view_layers[job.layer_name]
    sampling.check_usable(garment, scene, layer)
    span = frame_span(garment.selvedge, scene)
    folder = writing.bake_folder(garment)
    written = yield from with_frames(job, writing.write_scene(garment, scene, layer, span), span)
    if written is None:
        job.garment.selvedge.message = "stopped before the run"
        return
    run = folder / "run"
    arguments = ["simulate", folder / "scene.yaml", "--out", run, "--no-view"]
    for one in job.garment.selvedge.overrides.split(";"):
        arguments += ["--set", one.strip()] if one.strip() else []
    arguments += ["--resume=auto"] if job.resume else []
    summary = yield from asked(job, arguments, "simulates", stoppable=True)
    if summary is None:
        job.garment.selvedge.message = "stopped before the first frame"
        return
    yield from brought(job, run, summary, span, written)


def with_frames(job, frames, span):
    """Lets Blender go through the frames. Returns what the generator returns, or None where the job was stopped."""
    first, step, count = span
    job.waiting = False
    while not job.stopped:
        try:
            frame = next(frames)
        except StopIteration as end:
            return end.value
        job.text, job.fraction = f"reads frame {frame}", (frame - first + 1) / (step * count + 1)
        yield
    frames.close()
    return None


def asked(job, arguments, doing, stoppable=False):
    """The answer of the program; None where it was stopped before it had one."""
    job.run, job.waiting = Run(program_path(), arguments), True
    job.text, job.fraction = doing, 0.0
    asked_to_end = False
    while job.run.poll() is None:
        if stoppable and job.stopped and not asked_to_end:
            job.run.stop()
            asked_to_end = True
        if now := job.run.progress:
            job.text = f"{now.what} {now.at} of {now.of}" + (f", {now.left}" if now.left else "")
            job.fraction = now.at / max(1, now.of)
        yield
    job.waiting = False
    for warning in job.run.warnings:
        job.garment.selvedge.warnings.add().text = warning
    try:
        return job.run.json()
    except Failure:
        if asked_to_end and job.run.process.returncode != 2:
            return None
        raise


def brought(job, run, summary, span, written):
    """The result comes onto the garments, and frames with pairs are shown."""
    first, step, _ = span
    bad, folder = {}, run.parent
    export = folder / "export"
    made = yield from asked(job, ["export", run, "--format", "pc2", "--out", export], "reads the result")
    if audit.has_pairs(summary):
        report = yield from asked(job, ["check", run], "looks for pairs")
        bad = audit.bad_frames(report, first, step)
    exported = [file for file in made["files"] if file.endswith(".pc2")]  # in the order of the cloths
    targets = [folder / f"{mesh}.pc2" for mesh in written.meshes]
    for file, matrices, target in zip(exported, written.matrices.values(), targets):
        reading_back.write_cache(file, matrices, written.unit_scale, target)
    shutil.rmtree(export)
    garments = [found_object(name) for name in written.matrices]
    for left in reading_back.baked_together(job.garment):
        if left not in garments:
            reading_back.release(left, job.scene)
    reading_back.show_audit(garments, job.scene, bad, step)
    for garment, target in zip(garments, targets):
        reading_back.put_cache(garment, target, first, step)
        settings = garment.selvedge
        settings.baked_with = job.garment if garment != job.garment else None
        settings.message, settings.clean, settings.error = audit.verdict(summary), summary["clean"], ""
