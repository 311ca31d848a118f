"""Scenes that run: from a TOML file or a dict, step by step or to the end."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import weakref
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Set, Tuple, Union

import numpy as np

from . import _drape
from .view import View

PathLike = Union[str, "os.PathLike[str]"]
Record = Dict[str, Any]
Callback = Callable[[_drape.RunStep], Union[bool, np.bool_, None]]
_Begun = Tuple[_drape.Run, Path, Optional[Callable[[], Any]]]


def _remove(folder: str, owner: int) -> None:
    """Removes a temporary folder, unless this process is a fork of the one that made it."""
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


class Simulation(_drape.Simulation):
    """A scene made ready to run.

    scene: the path of a TOML file, or the same as a dict:
        {"simulation": {"duration": "1 s"}, "cloth": [{"mesh": "sheet.obj", "bend": "5 uN.m"}]}
    settings: what to change in it first, as the command line's --set does: {"cloth.0.bend": "10 uN.m"}.
    folder: what paths in the scene are relative to; by default the file's folder, of a dict the current one.

    ValueError says where the mistake is: "scene.toml:12: ..." or "scene['cloth'][0]['bend']: ...".
    """

    def __init__(
        self,
        scene: Union[PathLike, Mapping[str, Any]],
        settings: Optional[Mapping[str, Any]] = None,
        folder: Optional[PathLike] = None,
    ) -> None:
        given = dict(scene) if isinstance(scene, Mapping) else scene
        super().__init__(given, dict(settings or {}), folder)
        self._folder: Optional[Path] = None
        self._own_folders: Set[Path] = set()
        self._forget_scratch: Optional[Callable[[], Any]] = None

    def __setattr__(self, name: str, value: Any) -> None:
        """AttributeError for a name that a Simulation does not have: to set it would change nothing of the run."""
        if type(self) is Simulation and not name.startswith("_") and not hasattr(type(self), name):
            raise AttributeError(
                f"a Simulation has no '{name}' that could be set; make a new one with other settings, such as "
                "Simulation(scene, {'simulation.gravity': [0, 0, 0]})"
            )
        super().__setattr__(name, value)

    def advance(self, h: Optional[float] = None) -> _drape.RunStep:
        """One step of just h [s], by default the scene's time_step. StepError when it fails; the state is then as it was.

        run() shortens its steps to end at the times of frames; this does not.
        """
        step = self.time_step if h is None else h
        return _drape.Run(self, None, "none", step, step).step()

    def __iter__(self) -> Iterator[_drape.RunStep]:
        """The steps that are left of the scene's duration, one by one. Nothing is written.

        The loop may be left at any step. RuntimeError in the next step when another run came in between: run(),
        advance(), a second loop, view() without a run.
        """
        run = _drape.Run(self, None, "none")
        while not run.over:
            yield run.step()

    def run(
        self,
        duration: Optional[float] = None,
        out: Optional[PathLike] = None,
        callback: Optional[Callback] = None,
        frames: str = "pc2",
    ) -> Record:
        """Runs for `duration` [s], or for what is left of the scene's, and returns what run.json says.

        out: the folder for the files that `drape simulate` writes, another one for each run: ValueError when this
        simulation has written there. Without one the frames go to a temporary folder for view(), which is gone
        with the simulation.
        frames: "pc2", "obj" or "none".
        callback: is called with every step, a RunStep; when it returns False, of Python or NumPy, the run ends there.

        Ctrl-C, an exception in the callback and a step that fails (StepError) end the run as Ctrl-C ends the
        program: what was written is complete up to the last frame, run.json says so, and the exception goes on.
        """
        if callback is not None and not callable(callback):
            raise TypeError(f"callback: expected a function that takes a RunStep, not {callback!r}")
        if out is not None and not os.fspath(out):
            raise ValueError("out: expected the name of a folder, and it is empty; '.' is the current one")
        begun = self._begin(None if out is None else Path(out), frames, duration)
        run = begun[0]
        try:
            while not run.over:
                step = run.step()
                result = callback(step) if callback is not None else None
                if isinstance(result, (bool, np.bool_)) and not result:
                    break
        except BaseException as first:
            try:
                self._finish(*begun)
            except Exception:
                raise first  # with this one as its context: what ended the run comes before what follows
            raise
        return self._finish(*begun)

    @property
    def folder(self) -> Optional[Path]:
        """Where the last run's files are; None before there was one."""
        return self._folder

    def view(self, width: str = "100%", height: int = 600) -> View:
        """The last run, in a page that plays it; without one, the cloth as it is. A notebook shows it.

        width: as HTML has it; height: in pixels. ValueError when the viewer is not in this build.
        """
        if self._folder is None:
            self._finish(*self._begin(None, "pc2", 0))
        return View(_drape.view_html(self._folder), width, height)

    def _begin(self, out: Optional[Path], frames: str, duration: Optional[float]) -> _Begun:
        """A run, its folder, and what removes that: it is a temporary one without `out`.

        Nothing of the run before is touched: this one may be refused.
        """
        if out is not None:
            out = out.absolute()  # so that it is the same one after a change of the current folder
            if out.resolve() in self._own_folders:
                raise ValueError(
                    f"{out}: has the frames of this simulation's run so far, which this one would replace; "
                    "run into another folder, or make the simulation anew"
                )
            return _drape.Run(self, out, frames, duration), out, None
        folder = tempfile.mkdtemp(prefix="drape-")
        forget = weakref.finalize(self, _remove, folder, os.getpid())
        try:
            return _drape.Run(self, folder, frames, duration), Path(folder), forget
        except BaseException:
            forget()
            raise

    def _finish(self, run: _drape.Run, folder: Path, forget: Optional[Callable[[], Any]]) -> Record:
        """Its files are the last run's from now on; a temporary folder from before is removed."""
        try:
            record: Record = json.loads(run.finish())
        except BaseException:
            if forget is not None:
                forget()
            raise
        self._folder = folder
        self._own_folders.add(folder.resolve())
        if forget is not None:
            if self._forget_scratch is not None:
                self._forget_scratch()
            self._forget_scratch = forget
        return record

    def __repr__(self) -> str:
        names = ", ".join(cloth.name for cloth in self.cloths)
        return f"Simulation({names}; time={self.time:g} s of {self.duration:g} s)"


def read_scene(
    scene: Union[PathLike, Mapping[str, Any]],
    settings: Optional[Mapping[str, Any]] = None,
    folder: Optional[PathLike] = None,
) -> Simulation:
    """Simulation(scene, settings, folder)."""
    return Simulation(scene, settings, folder)
