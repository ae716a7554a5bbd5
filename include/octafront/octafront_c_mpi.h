#ifndef OCTAFRONT_C_MPI_H
#define OCTAFRONT_C_MPI_H

/** @file
 * Meshes that the processes of an MPI communicator make together, in C. All of it is in this header: the library needs
 * no MPI, and any MPI will do. The thread that waits for a job speaks for it, so MPI_THREAD_FUNNELED is enough.
 *
 *     octafront_mpi_options(options, communicator);
 *     job = octafront_generate(surface, options, 0);                     (on all processes)
 *     while (octafront_mpi_wait(job, communicator, -1, &event) != OCTAFRONT_EVENT_END) { ... }
 *
 * Example: examples/mesh_with_mpi.c. */

#include <octafront/octafront_c.h>

#include <mpi.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

/** octafront_options_ranks() of a communicator. */
static inline int octafront_mpi_options(octafront_options* options, MPI_Comm communicator) {
  int rank = 0, size = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &size);
  return octafront_options_ranks(options, rank, size);
}

/** As MPI counts: sizes, and behind them where each begins. Null: no memory. */
static inline int* octafront_mpi_counts(const size_t* sizes, int count) {
  int r = 0, first = 0;
  int* counts = (int*)malloc(2 * (size_t)count * sizeof(int));
  for (; counts != NULL && r < count; ++r) {
    counts[r] = (int)sizes[r];
    counts[count + r] = first;
    first += counts[r];
  }
  return counts;
}

/** Does what an event of talk asks for; 0 if the event is none. A process that cannot is lost, and ends all. */
static inline int octafront_mpi_talk(const octafront_event* event, MPI_Comm communicator) {
  int rank = 0, size = 1, failed = 0;
  int *in = NULL, *out = NULL;
  const int gathers = event->kind == OCTAFRONT_EVENT_GATHER;
  if (!gathers && event->kind != OCTAFRONT_EVENT_EXCHANGE) return 0;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &size);
  in = octafront_mpi_counts(event->in_sizes, size);
  out = gathers ? NULL : octafront_mpi_counts(event->out_sizes, size);
  if (in == NULL || (!gathers && out == NULL))
    failed = 1;
  else if (gathers)
    failed = MPI_Allgatherv(event->out, in[rank], MPI_BYTE, event->in, in, in + size, MPI_BYTE, communicator);
  else
    failed = MPI_Alltoallv(event->out, out, out + size, MPI_BYTE, event->in, in, in + size, MPI_BYTE, communicator);
  if (failed != 0) MPI_Abort(communicator, OCTAFRONT_INTERNAL);
  free(in);
  free(out);
  return 1;
}

/** octafront_job_wait() of a job of processes: serves their talk, and returns the next other event. Without an end of
 * time, `seconds` below 0, it returns when there is one; else they are those between two words of talk. */
static inline int octafront_mpi_wait(octafront_job* job, MPI_Comm communicator, double seconds,
                                     octafront_event* event) {
  for (;;) {
    const int kind = octafront_job_wait(job, seconds, event);
    if (!octafront_mpi_talk(event, communicator)) return kind;
    octafront_job_answer(job);
  }
}

#ifdef __cplusplus
}
#endif

#endif
