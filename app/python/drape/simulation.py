"""Scenes that run: from a TOML file or a dict, step by step or to the end."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import weakref
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Union

from . import _drape
from .view import View

PathLike = Union[str, "os.PathLike[str]"]
Record = Dict[str, Any]
Callback = Callable[[_drape.RunStep], Optional[bool]]


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
        self._forget_scratch: Optional[Callable[[], Any]] = None

    def advance(self, h: Optional[float] = None) -> _drape.RunStep:
        """One step of h [s], by default the scene's. StepError when it fails; the state is then as it was."""
        step = self.time_step if h is None else h
        return _drape.Run(self, None, "none", step, step).step()

    def __iter__(self) -> Iterator[_drape.RunStep]:
        """The steps that are left of the scene's duration, one by one. Nothing is written."""
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

        out: the folder for the files that `drape simulate` writes. Without one the frames go to a temporary
        folder for view(), which is gone with the simulation.
        frames: "pc2", "obj" or "none".
        callback: is called with every step, a RunStep; when it returns False the run ends there.

        Ctrl-C, an exception in the callback and a step that fails (StepError) end the run as Ctrl-C ends the
        program: what was written is complete up to the last frame, run.json says so, and the exception goes on.
        """
        folder = self._scratch_folder() if out is None else Path(out)
        run = _drape.Run(self, folder, frames, duration)
        try:
            while not run.over:
                step = run.step()
                if callback is not None and callback(step) is False:
                    break
        finally:
            record: Record = json.loads(run.finish())
            self._folder = folder
        return record

    @property
    def folder(self) -> Optional[Path]:
        """Where the last run's files are; None before there was one."""
        return self._folder

    def view(self, width: str = "100%", height: int = 600) -> View:
        """The last run, in a page that plays it; without one, the cloth as it is. A notebook shows it.

        width: as HTML has it; height: in pixels. ValueError when the viewer is not in this build.
        """
        if self._folder is None:
            folder = self._scratch_folder()
            _drape.Run(self, folder, "pc2", 0).finish()
        else:
            folder = self._folder
        return View(_drape.view_html(folder), width, height)

    def _scratch_folder(self) -> Path:
        """A new one; the one before is removed, and this one with the simulation."""
        if self._forget_scratch is not None:
            self._forget_scratch()
        folder = tempfile.mkdtemp(prefix="drape-")
        self._forget_scratch = weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        return Path(folder)

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
