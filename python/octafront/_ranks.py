"""Processes that make one mesh together, by a communicator of mpi4py. What they say to each other goes through the one
who waits for a job: neither this package nor the library needs MPI or mpi4py."""

import ctypes
import os

from . import errors
from ._library import demand
from ._numpy import np

_NEEDED = ("Get_rank", "Get_size", "Allgatherv", "Alltoallv", "allgather")


def ranks_of(comm):
    """The processes of `comm`; None: this one alone."""
    if comm is None:
        return Alone()
    if not all(hasattr(comm, name) for name in _NEEDED) or comm.Is_inter():
        raise errors.OptionError(f"`comm` is a communicator of mpi4py within one group, such as MPI.COMM_WORLD, not {comm!r}")
    return Ranks(comm) if comm.Get_size() > 1 else Alone()


class Alone:
    """One process, which has nobody to talk to."""

    def together(self, work):
        return work()

    def join(self, settings):
        """The arguments of a job, beside what it works on, that make it one of these processes."""
        return {}


class Ranks:
    def __init__(self, comm):
        self._comm, self.rank, self.size = comm, comm.Get_rank(), comm.Get_size()

    def together(self, work):
        """work() on each; where it fails on one, it fails on all."""
        made = failure = None
        try:
            made = work()
        except BaseException as error:
            failure = error
        told = self._comm.allgather(None if failure is None else (type(failure).__name__, str(failure)))
        if failure is not None:
            raise failure
        for rank, said in enumerate(told):
            if said is not None:
                raise _as_told(f"rank {rank} of {self.size}: ", *said)
        return made

    def join(self, settings):
        demand("options_ranks", settings.options, self.rank, self.size)
        import platform
        here = self._comm.allgather(platform.node()).count(platform.node())
        settings.threads = settings.threads or _share_of_threads(here)
        return {"ranks": self}

    def talk(self, event, gathers):
        """What an event of the library asks for."""
        in_sizes = event.in_sizes[:self.size]
        into = [_memory(event.into, sum(in_sizes)), in_sizes]
        if gathers:
            self._comm.Allgatherv(_memory(event.out, in_sizes[self.rank]), into)
        else:
            out_sizes = event.out_sizes[:self.size]
            self._comm.Alltoallv([_memory(event.out, sum(out_sizes)), out_sizes], into)


def _memory(address, size):
    if size == 0:
        return np.empty(0, np.uint8)
    return np.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(ctypes.c_uint8)), (size,))


def _share_of_threads(processes):
    """The machine's threads are shared by the processes on it; where each is bound to some, these are its own."""
    machine = os.cpu_count() or 1
    bound = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else machine
    return bound if bound < machine else max(1, machine // processes)


def _as_told(where, name, text):
    if name == "MemoryError":
        return MemoryError(where + text)
    if name == "KeyboardInterrupt":
        return errors.Cancelled(where + "interrupted")
    kind = getattr(errors, name, None)
    if isinstance(kind, type) and issubclass(kind, errors.Error):
        return kind(where + text)
    return errors.InternalError(f"{where}{name}: {text}")
