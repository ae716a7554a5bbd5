/* From C, or any language that can call it: makes a cube, meshes it while telling how far it is, looks at the result, and
 * writes it: mesh_from_c NEW_FILE */

#include <octafront/octafront_c.h>

#include <stdio.h>
#include <string.h>

/* Waits for the end of a job; 0 if it did what it should. */
static int finish(octafront_job* job) {
  octafront_event event;
  while (octafront_job_wait(job, -1, &event) != OCTAFRONT_EVENT_END)
    if (event.kind == OCTAFRONT_EVENT_PROGRESS) printf("%s\n", event.text);
  if (octafront_job_status(job) != OCTAFRONT_DONE) fprintf(stderr, "%s\n", octafront_job_message(job));
  return octafront_job_status(job);
}

/* Whether there is a file of that name: it may be somebody's model. */
static int is_there(const char* name) {
  FILE* file = fopen(name, "rb");
  if (file != NULL) fclose(file);
  return file != NULL;
}

int main(int argc, char** argv) {
  const double points[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const uint32_t triangles[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  octafront_surface* cube;
  octafront_options* options;
  octafront_mesh* mesh = NULL;
  octafront_job* job = NULL;
  octafront_array tets;
  int status;
  if (argc != 2 || is_there(argv[1])) {
    if (argc == 2) fprintf(stderr, "%s is there already, and stays as it is\n", argv[1]);
    fprintf(stderr, "usage: mesh_from_c NEW_FILE     writes the mesh of a cube, by the ending: .vtu, .msh, .inp, ...\n");
    return OCTAFRONT_USAGE;
  }

  cube = octafront_surface_new();
  options = octafront_options_new();
  status = octafront_surface_set_array(cube, "points", points, 8) ||
               octafront_surface_set_array(cube, "triangles", triangles, 12) ||
               octafront_options_set(options, "{\"size\": 0.2, \"interior\": \"graded\"}");
  if (status != 0) fprintf(stderr, "%s\n", octafront_last_error());

  if (status == 0) {
    job = octafront_generate(cube, options, 0);
    status = finish(job);
    mesh = octafront_job_take_mesh(job);
    octafront_job_free(job);
  }
  if (status == 0) {
    octafront_mesh_array(mesh, "tets", &tets);
    printf("%lu tetrahedra; %s\n", (unsigned long)tets.rows, octafront_mesh_summary(mesh));
    job = octafront_write_mesh(mesh, argv[1], NULL);
    status = finish(job);
    octafront_job_free(job);
  }
  octafront_mesh_free(mesh);
  octafront_options_free(options);
  octafront_surface_free(cube);
  return status;
}
