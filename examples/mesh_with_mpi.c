/* One mesh by several processes, from C: each gets the whole mesh, and the first one writes it.
 *   mpirun -n 2 mesh_with_mpi SURFACE NEW_FILE [ELEMENTS] */

#include <octafront/octafront_c_mpi.h>

#include <stdio.h>

/* Waits for the end of a job of all processes; 0 if it did what it should. All end alike, so the first one speaks. */
static int finish(octafront_job* job, int rank) {
  octafront_event event;
  while (octafront_mpi_wait(job, MPI_COMM_WORLD, -1, &event) != OCTAFRONT_EVENT_END)
    if (rank == 0 && event.kind == OCTAFRONT_EVENT_PROGRESS) printf("%s\n", event.text);
  if (rank == 0 && octafront_job_status(job) != OCTAFRONT_DONE) fprintf(stderr, "%s\n", octafront_job_message(job));
  return octafront_job_status(job);
}

static int make_mesh(int rank, const char* in, const char* out, const char* elements) {
  octafront_options* options = octafront_options_new();
  octafront_surface* part = NULL;
  octafront_mesh* mesh = NULL;
  octafront_job* job = NULL;
  octafront_array tets;
  char json[100];
  int status;
  snprintf(json, sizeof json, "{\"elements\": %.20s}", elements);
  status = octafront_options_set(options, json) || octafront_mpi_options(options, MPI_COMM_WORLD);
  if (status != 0 && rank == 0) fprintf(stderr, "%s\n", octafront_last_error());

  if (status == 0) {
    job = octafront_open_files(&in, 1, "{}", options, 0);
    status = finish(job, rank);
    part = octafront_job_take_surface(job);
    octafront_job_free(job);
  }
  if (status == 0) {
    job = octafront_generate(part, options, 0);
    status = finish(job, rank);
    mesh = octafront_job_take_mesh(job);
    octafront_job_free(job);
  }
  if (status == 0 && rank == 0) {
    octafront_mesh_array(mesh, "tets", &tets);
    printf("%lu tetrahedra\n", (unsigned long)tets.rows);
    job = octafront_write_mesh(mesh, out, NULL); /* by this process alone */
    status = finish(job, rank);
    octafront_job_free(job);
  }
  octafront_mesh_free(mesh);
  octafront_surface_free(part);
  octafront_options_free(options);
  return status;
}

int main(int argc, char** argv) {
  int provided = 0, rank = 0, status = OCTAFRONT_USAGE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (argc == 3 || argc == 4)
    status = make_mesh(rank, argv[1], argv[2], argc == 4 ? argv[3] : "20000");
  else if (rank == 0)
    fprintf(stderr, "usage: mesh_with_mpi SURFACE NEW_FILE [ELEMENTS]     NEW_FILE is overwritten\n");
  MPI_Finalize();
  return status;
}
