"""Work of the library: a thread of its own does it, and the caller's waits here, in Python, where Ctrl-C reaches it and
his own functions run."""

import ctypes
import json

from . import errors
from ._library import Event, call, spoken, text_of
from ._numpy import np

# Often enough for a hand on Ctrl-C, seldom enough to cost nothing.
_LOOK_EVERY = 0.05
_END, _PROGRESS, _SIZES, _PASS, _GATHER, _EXCHANGE = 1, 2, 3, 4, 5, 6


class Job:
    """`start` is the name of a function that begins a job; what it takes must live until the job has ended.

    progress(phase, fraction): fraction in [0, 1], or None where it is unknown; False ends the job.
    size_at(points): sizes (n,) at points (n, 3).
    after_pass(name, worst): told of the worst element each time when passes have been over the mesh.
    ranks: the Ranks whose processes do the job together.
    """

    def __init__(self, start, *arguments, progress=None, size_at=None, after_pass=None, ranks=None):
        self._keep, self._ranks = arguments, ranks
        self._calls = {_PROGRESS: progress, _SIZES: size_at, _PASS: after_pass}
        self.stopped = False
        self._address = call(start, *arguments)
        if not self._address:
            raise MemoryError(text_of(call("last_error")))

    def __del__(self, call=call):
        self._free(call)

    def _free(self, call=call):
        if getattr(self, "_address", None):
            address, self._address = self._address, None
            call("job_free", ctypes.c_void_p(address))

    def run(self):
        """Waits for the end; returns the report. Raises what the library or a function of the caller raised."""
        event = Event()
        try:
            while call("job_wait", self._address, _LOOK_EVERY, ctypes.byref(event)) != _END:
                self._serve(event)
        except BaseException:
            # Also KeyboardInterrupt: the job ends first, in milliseconds.
            self._end(event)
            raise
        report = json.loads(call("job_report", self._address), object_hook=_with_spoken_notes)
        status = call("job_status", self._address)
        if status != 0:
            raise self._failure(status, spoken(text_of(call("job_message", self._address))), report)
        return report

    def _end(self, event):
        # Other processes wait to hear of it.
        call("job_cancel", self._address)
        while self._ranks and call("job_wait", self._address, _LOOK_EVERY, ctypes.byref(event)) != _END:
            self._serve_talk(event)
        self._free()

    def take(self, kind):
        """The address of the surface, mesh or sizes that the job made, or None."""
        return call("job_take_" + kind, self._address)

    def bytes(self):
        """What the job made of bytes, such as a picture."""
        length = ctypes.c_size_t()
        at = call("job_bytes", self._address, ctypes.byref(length))
        return ctypes.string_at(at, length.value)

    def _serve(self, event):
        self._serve_talk(event)
        if event.kind == _SIZES:
            self._serve_sizes(event)
        elif event.kind == _PROGRESS and self._calls[_PROGRESS]:
            fraction = event.values[0] if event.values[0] >= 0 else None
            if self._calls[_PROGRESS](text_of(event.text), fraction) is False:
                self.stopped = True
                call("job_cancel", self._address)
        elif event.kind == _PASS:
            beta, least, largest, positive = event.values
            self._calls[_PASS](text_of(event.text), {"beta": beta, "dihedral_min": least, "dihedral_max": largest,
                                                     "positive": positive != 0})

    def _serve_talk(self, event):
        if event.kind not in (_GATHER, _EXCHANGE):
            return
        try:
            self._ranks.talk(event, event.kind == _GATHER)
        except BaseException:
            # Nobody knows what was said: this process is lost to the others.
            self._ranks = None
            raise
        call("job_answer", self._address)

    def _serve_sizes(self, event):
        points = np.ctypeslib.as_array(event.points, (event.count, 3)).copy()
        sizes = np.asarray(self._calls[_SIZES](points), dtype=np.float64)
        if sizes.shape not in ((), (event.count,)):
            raise errors.OptionError(f"the size function got points of shape {points.shape} and returned sizes of "
                                     f"shape {sizes.shape}: it has to return ({event.count},), one for each point")
        np.ctypeslib.as_array(event.sizes, (event.count,))[:] = sizes
        call("job_answer", self._address)

    def _failure(self, status, message, report):
        if status == 6:
            return MemoryError(message)
        if status == 130:
            return errors.Cancelled("the progress function returned False" if self.stopped else message)
        if status == 3:
            error = errors.InputError(message)
            error.defects, error.leak = report.get("defects"), report.get("leak")
            return error
        cavity = self.take("surface") if status == 4 else None
        if cavity:
            from ._surface import Surface
            error = errors.OpenCavityError(message)
            error.cavity = Surface._of(cavity)
            return error
        if status == 4:
            error = errors.MeshingError(message)
            error.report = report or None
            return error
        kinds = {2: errors.OptionError, 5: errors.OutputError}
        return kinds.get(status, errors.InternalError)(message)


def _with_spoken_notes(node):
    if "notes" in node:
        node["notes"] = [spoken(note) if isinstance(note, str) else {**note, "text": spoken(note["text"])}
                         for note in node["notes"]]
    return node
