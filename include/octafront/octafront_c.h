#ifndef OCTAFRONT_C_H
#define OCTAFRONT_C_H

/** @file
 * The library for other languages: opaque objects, arrays by name, and jobs. The package for Python stands on it.
 *
 * - Objects belong to the caller and are freed by him; what they point to is theirs. Null may be freed.
 * - Work is a *job*: it runs on a thread of its own, and the caller waits for events. So no code of the caller is ever
 *   called by ours: no callbacks, no foreign threads, and a wait can end at any time to look whether somebody pressed
 *   Ctrl-C. (Of builds without threads octafront_job_watch() says more.) Objects that a job was given must live,
 *   unchanged, until it is freed; freeing cancels it and waits.
 * - Texts end with 0 and are UTF-8 as far as files and callers gave UTF-8; JSON is always UTF-8.
 * - Functions that can fail return 0 for success, and octafront_last_error() says, per thread, what was wrong.
 *
 * Example: examples/mesh_from_c.c. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct octafront_surface octafront_surface; /**< a SurfaceMesh, or a Domain (octafront/domain.h) */
typedef struct octafront_mesh octafront_mesh;       /**< a TetMesh (octafront/tet_mesh.h) */
typedef struct octafront_sizes octafront_sizes;     /**< a SizeField (octafront/size_field.h) */
typedef struct octafront_image octafront_image;     /**< an Image (octafront/image.h) */
typedef struct octafront_options octafront_options; /**< Options (octafront/options.h) */
typedef struct octafront_job octafront_job;

/** How a job ended; the exit statuses of the command line. */
enum {
  OCTAFRONT_DONE = 0,
  OCTAFRONT_INTERNAL = 1, /**< a bug of ours */
  OCTAFRONT_USAGE = 2,    /**< options or arguments */
  OCTAFRONT_INPUT = 3,    /**< the input cannot be read or meshed */
  OCTAFRONT_MESHING = 4,  /**< no valid mesh; octafront_job_take_surface() has a cavity that stayed open, if one did */
  OCTAFRONT_OUTPUT = 5,   /**< not written */
  OCTAFRONT_MEMORY = 6,   /**< out of memory */
  OCTAFRONT_CANCELLED = 130
};

/** Of the library, e.g. "0.1.0". */
const char* octafront_version(void);
/** What is wrong, of the last call of this thread that failed. */
const char* octafront_last_error(void);
/** JSON, an array: name, field, group, tasks, kind, choices, default, without, range, is_length, help of each option
 * (octafront/option_table.h). */
const char* octafront_option_table(void);
/** The same of what is asked on the way in, IntakeOptions: keys for octafront_open_files() and its like. */
const char* octafront_intake_table(void);
/** JSON, an array: name, metres and words of each unit of length (octafront/units.h). */
const char* octafront_units(void);
/** The unit that a file says its coordinates are in, "" for none; null if it is an image that cannot be read. Valid
 * until the next call of this thread. */
const char* octafront_unit_of_file(const char* file);
/** 1 if the file is one of CAD: is_cad() of octafront/cad.h. */
int octafront_is_cad(const char* file);
/** JSON, an array: name, title, endings, what can be read and written, of each file format. */
const char* octafront_formats(void);

/* ---- arrays ---- */

enum { OCTAFRONT_F64 = 1, OCTAFRONT_U32 = 2 };

/** `rows` times `columns` values, row by row. Stays valid until its object is changed or freed. */
typedef struct {
  const void* data; /**< may be null if rows is 0 */
  size_t rows;
  uint32_t columns;
  uint32_t type;
} octafront_array;

/** Arrays of a surface: points (F64 x 3), triangles (U32 x 3), patch, source (U32 x 1), sides (U32 x 2: region in
 * front, behind; 0xffffffff: outside), bound (F64 x 1: of a mended surface, how near a mesh of automatic sizes stays to
 * each triangle where repair moved something; infinite elsewhere). Its lists of names: patch_names, region_names. */
octafront_surface* octafront_surface_new(void);
void octafront_surface_free(octafront_surface* surface);
int octafront_surface_array(const octafront_surface* surface, const char* name, octafront_array* out);
/** Copies `rows` rows. */
int octafront_surface_set_array(octafront_surface* surface, const char* name, const void* data, size_t rows);
int octafront_surface_add_name(octafront_surface* surface, const char* list, const char* name, size_t length);
/** The i-th name of a list, null behind the last one. */
const char* octafront_surface_name(const octafront_surface* surface, const char* list, size_t i, size_t* length);

/** Of a complex made from an image, the smallest distance of its voxels: octafront_generate() works by options that
 * suit them; 0: it is not from an image. Opening an image sets it. */
double octafront_surface_voxel(const octafront_surface* surface);
void octafront_surface_set_voxel(octafront_surface* surface, double spacing);

/** Arrays of a mesh: points (F64 x 3), tets (U32 x 4), region (U32 x 1), boundary (U32 x 3), patch, source (U32 x 1),
 * interfaces (U32 x 3), interface_patch (U32 x 1), curve_edges (U32 x 2), curve (U32 x 1), mid_nodes (U32 x 6),
 * high_nodes (U32 x 1: of order 3 and 4 the 16 or 31 nodes of each tet behind its corners, as octafront::TetMesh has
 * them), wide_cells (U32 x 8: of wedges and pyramids the first tet, the number of tets, six nodes), wide_faces (U32 x
 * 5: of their quadrilaterals the first face, four nodes), split_faces (U32 x 7: three corners behind, their partners in
 * front, the patch in front), opened_contacts (U32 x 3: two patches that lie on each other, and 1 if their triangles
 * are the same, else 0), periods (F64 x 3: of a periodic cell the translations), period_rotations (F64 x 9: the
 * matrices of periods, row by row; none if all are translations), periodic_nodes (U32 x 3: the number of a period, a
 * node that is a copy, the node that it is a copy of). Of what octafront_adapt() left also old_of_new and
 * old_tet_of_new (U32 x 1: the number in the old mesh of each point and tet, 0xffffffff: new), to be read. Its lists of
 * names: region_names, patch_names, curve_names. */
octafront_mesh* octafront_mesh_new(void);
void octafront_mesh_free(octafront_mesh* mesh);
int octafront_mesh_array(const octafront_mesh* mesh, const char* name, octafront_array* out);
int octafront_mesh_set_array(octafront_mesh* mesh, const char* name, const void* data, size_t rows);
int octafront_mesh_add_name(octafront_mesh* mesh, const char* list, const char* name, size_t length);
const char* octafront_mesh_name(const octafront_mesh* mesh, const char* list, size_t i, size_t* length);

enum { OCTAFRONT_NODES = 0, OCTAFRONT_EDGES = 1, OCTAFRONT_FACES = 2, OCTAFRONT_ELEMENTS = 3 };

/** carried() of octafront/adapt.h: values of `before`, at its points or of its elements, on what octafront_adapt() made
 * of it. `components` numbers for each; `out` has room for those of `adapted`. */
int octafront_carry_field(const octafront_mesh* before, const octafront_mesh* adapted, int of_elements,
                          size_t components, const double* values, double* out);

/** The further sets of a mesh (NamedSet). */
size_t octafront_mesh_sets(const octafront_mesh* mesh);
int octafront_mesh_set(const octafront_mesh* mesh, size_t i, int* kind, const char** name, size_t* length,
                       octafront_array* members);
/** Members ascending, each once. */
int octafront_mesh_add_set(octafront_mesh* mesh, int kind, const char* name, size_t length, const uint32_t* members,
                           size_t count);
/** The nodes, faces or elements in the box (2 x 3) or ball (centre, radius: 4), or the faces of patches, as add_group()
 * of octafront/named_groups.h finds them; null where not meant. `note` gets a sentence, or "", valid until the next
 * call of this thread. */
int octafront_mesh_add_group(octafront_mesh* mesh, int kind, const char* name, size_t length, const double* box,
                             const double* ball, const char* const* patches, size_t patch_count, const char** note);
/** beta = 3 r / R of each tetrahedron, and its least and largest dihedral angle in degrees; null where not wanted. */
int octafront_mesh_quality(const octafront_mesh* mesh, double* beta, double* least, double* largest);
/** JSON: the same summary as in reports. Valid until the next call of this thread. */
const char* octafront_mesh_summary(const octafront_mesh* mesh);

/* ---- images ---- */

enum { OCTAFRONT_U8 = 3, OCTAFRONT_I16 = 4, OCTAFRONT_U16 = 5, OCTAFRONT_I32 = 6, OCTAFRONT_F32 = 7 };

/** Voxels: size[0] x size[1] x size[2] values of a type above, copied, the first ones along i. `map`: the first three
 * rows of the matrix from (i, j, k, 1) to the world, 3 x 4. Null if that makes no image. */
octafront_image* octafront_image_new(int type, const uint32_t* size, const void* values, const double* map);
void octafront_image_free(octafront_image* image);

/* ---- sizes and options ---- */

void octafront_sizes_free(octafront_sizes* sizes);
/** Edge lengths wanted at `n` points (n x 3). */
int octafront_sizes_at(const octafront_sizes* sizes, const double* points, size_t n, double* out);
/** The metrics that ask for these lengths: `n` symmetric matrices M of 3 x 3, in 1 / (unit of the points)^2. An edge e
 * has the wanted length where e^T M e = 1. Sizes are the same in all directions: M is the identity / (edge length)^2.
 */
int octafront_sizes_metric_at(const octafront_sizes* sizes, const double* points, size_t n, double* out);
void octafront_sizes_bounds(const octafront_sizes* sizes, double* least, double* largest);
octafront_sizes* octafront_sizes_uniform(double h);
/** The sizes as bytes, valid until the next call of this thread: for another process of this machine, where they become
 * the same sizes, bit for bit. Fails for those of a function. */
int octafront_sizes_pack(const octafront_sizes* sizes, const char** bytes, size_t* length);
/** Null where the bytes are not such sizes. */
octafront_sizes* octafront_sizes_unpack(const char* bytes, size_t length);

octafront_options* octafront_options_new(void);
void octafront_options_free(octafront_options* options);
/** `json`: an object of names of octafront_option_table() and their values. */
int octafront_options_set(octafront_options* options, const char* json);
/** SizeOptions::regions: `n` rows of x0 y0 z0 x1 y1 z1 radius size. */
int octafront_options_regions(octafront_options* options, const double* rows, size_t n);
/** SizeOptions::point_sizes: `n` rows of x y z size. */
int octafront_options_point_sizes(octafront_options* options, const double* rows, size_t n);
/** The same two from files (read_size_regions, read_point_sizes of octafront/io.h). */
int octafront_options_regions_file(octafront_options* options, const char* file);
int octafront_options_point_sizes_file(octafront_options* options, const char* file);
/** SizeOptions::named: the size of the region, patch or curve of that name. */
int octafront_options_size_of(octafront_options* options, const char* name, size_t length, double size);
/** Options::groups: one more, "NAME=PLACE". */
int octafront_options_group(octafront_options* options, const char* text, size_t length);
/** SizeOptions::near: by a name, or where it is null or empty by a point (3). */
int octafront_options_size_near(octafront_options* options, const char* name, size_t length, const double* point,
                                double size, double distance);
/** read_sizes_into() of octafront/io.h: FILE or FILE:FIELD, a background grid or a mesh with a field of sizes. */
int octafront_options_sizes_file(octafront_options* options, const char* named);
/** SizeOptions::mesh: points (n x 3), elements of 4 or 3 corners each, sizes per point or, with `of_elements`, per
 * element. Copied. */
int octafront_options_size_mesh(octafront_options* options, const double* points, size_t n, const uint32_t* elements,
                                size_t count, uint32_t corners, const double* sizes, int of_elements);
/** SizeOptions::field. */
int octafront_options_field(octafront_options* options, const octafront_sizes* sizes);
/** options_for_voxels() of octafront/generate.h, after all other options; octafront_generate() does so by itself. */
void octafront_options_for_voxels(octafront_options* options, double spacing);
/** Jobs with these options are done by `size` processes together, of which this one is number `rank`, from 0 on; all
 * give the same arguments but for these two numbers and `threads`. octafront_generate() shares its work, and all get
 * the same mesh, the one that a process alone gets; octafront_open_files() does all on each, and ends alike on all.
 * What processes say to each other goes by events, talk, which octafront/octafront_c_mpi.h serves by MPI; until the end
 * of the job, also once it is cancelled: a process that is missing is waited for by the others. */
int octafront_options_ranks(octafront_options* options, int rank, int size);
/** Jobs with these options ask for sizes, or tell of passes, by events. */
void octafront_options_ask_sizes(octafront_options* options);
void octafront_options_tell_passes(octafront_options* options);

/* ---- jobs ---- */

enum {
  OCTAFRONT_EVENT_NONE = 0, /**< the time is over */
  OCTAFRONT_EVENT_END,      /**< the job has ended */
  OCTAFRONT_EVENT_PROGRESS, /**< text, value: the stage, its fraction in [0, 1], or below 0 where it is unknown */
  OCTAFRONT_EVENT_SIZES,    /**< points, count, sizes: fill in the sizes, then octafront_job_answer() */
  OCTAFRONT_EVENT_PASS,     /**< text, values: a pass of improvement, then worst beta, least and largest dihedral angle,
                               1 if all elements are positive */
  OCTAFRONT_EVENT_GATHER,   /**< talk: in_sizes[r] bytes that process r has in its `out` go into `in` of all, in the
                               order of processes */
  OCTAFRONT_EVENT_EXCHANGE  /**< talk: out_sizes[r] bytes of `out` go to process r, in_sizes[r] bytes from it into `in`,
                               each in the order of processes */
};

/** What it points to is valid until the next wait. */
typedef struct {
  int kind;
  const char* text;
  double values[4];
  const double* points; /**< count x 3 */
  double* sizes;        /**< count, to be filled in */
  size_t count;
  /** Of talk: all processes get the same event at the same time; octafront_job_answer() once `in` is filled. All sizes
   * together are less than 2^31. */
  const void* out;
  void* in;
  const size_t* out_sizes; /**< null if the kind has none */
  const size_t* in_sizes;
} octafront_event;

/** `threads`: at most so many; 0: all. A job begins at once; these return null only if there is no memory or thread.
 * Options may be null where they are the defaults. */
octafront_job* octafront_read_surface(const char* file); /**< -> surface; of CAD a domain, as octafront_open_files() */
octafront_job* octafront_write_surface(const octafront_surface* surface, const char* file);
octafront_job* octafront_read_mesh(const char* file); /**< -> mesh */
/** `options`: null, or JSON, an object of any of format (a name of octafront_formats(); else by the ending of the
 * file), ascii (true: as text), cells_only (true: tetrahedra alone), polyhedral (true: the dual), parts (a number: so
 * many parts), partitioner ("curve", "metis"), split_files (true: MSH in parts, a file each), job (what makes it a job
 * of a solver, an object or the name of a file of it: octafront/solver_job.h), deck (true: an OpenFOAM case), speed,
 * fluid ("air"), unit ("mm": what coordinates count, for deck): WriteOptions of octafront/io.h. The report has notes.
 */
octafront_job* octafront_write_mesh(const octafront_mesh* mesh, const char* file, const char* options);
octafront_job* octafront_read_sizes(const char* file, double gradation); /**< -> sizes */
octafront_job* octafront_write_sizes(const octafront_sizes* sizes, const char* file);
/** -> image: read_image() of octafront/image.h, a file, a folder or several files; `series` 0: the only one. */
octafront_job* octafront_read_image(const char* const* files, size_t count, uint32_t series);
/** -> surface, a domain: open_domain() of octafront/domain.h, the way in that the command line takes too: regions of
 * what has walls or parts inside, mending of what has defects, images as regions. Of several files or bodies each is a
 * region. What octafront_generate() makes of the result is what `octafront mesh` makes of the same files. The report
 * has format, notes, regions (names and volumes), repair (of one of several: "repair NAME"; mend_surface()),
 * dropped_sheet_faces, and of images voxel, the smallest spacing, and size; that of a failure may have `leak`, the way
 * through a hole. Bodies are copied.
 *
 * `json` is an object, all of whose keys may be missing: the names of octafront_intake_table(), and regions
 * ([["steel", [x, y, z]], ...]), voids ([[x, y, z], ...]); what lies inside (octafront/inside.h): sheet_files,
 * wire_files, point_files (["fault.stl", "NAME=FILE", ...]), and arrays, inside_sheets ([["fault", points, triangles],
 * ...]), inside_wires ([["wire", points, edges], ...]), inside_points ([["probe", points], ...]); for images size (that
 * elements will have), names ([[3, "liver"], ...]), names_file, ignore ([0, 7]), merge ([["cortex", [3, 4]], ...]),
 * bands ([["bone", 226, null], ...]), surface_of ([["cortex", "pial.stl"], ...]), crop ([[first, last], ...], null for
 * an end that stays), resample (one or three); for CAD apart
 * (["fillet", ...]); for formulas box ([x0, y0, z0, x1, y1, z1]).
 *
 * `options`: what octafront_generate() will be given, or null: files of CAD are triangulated for its sizes, as
 * intake_for() of octafront/domain.h says. */
octafront_job* octafront_open_files(const char* const* files, size_t count, const char* json,
                                    const octafront_options* options, int threads);
octafront_job* octafront_open_surface(const octafront_surface* surface, const char* json, int threads);
octafront_job* octafront_open_bodies(const octafront_surface* const* bodies, const char* const* names, size_t count,
                                     const char* json, int threads);
octafront_job* octafront_image_surface(const octafront_image* image, const char* json, int threads);
/** -> surface, a domain: open_samples() of octafront/formula.h. `size`: cells along x, y and z; `box`: its least and
 * largest corner, 6 numbers; `values`: (size[0] + 2) x (size[1] + 2) x (size[2] + 2) of them, copied. Formulas are
 * files to octafront_open_files(). */
octafront_job* octafront_open_samples(const double* values, const uint32_t* size, const double* box, const char* json,
                                      int threads);
/** 1 if is_formula() of octafront/formula.h says so. */
int octafront_is_formula(const char* input);
/** -> mesh, sizes: generate(). A surface that was not opened is taken as it is, and refused if it has defects. */
octafront_job* octafront_generate(const octafront_surface* surface, const octafront_options* options, int threads);
/** -> surface, sizes: generate_surface(). */
octafront_job* octafront_generate_surface(const octafront_surface* surface, const octafront_options* options,
                                          int threads);
/** -> sizes: generate_sizes(). */
octafront_job* octafront_generate_sizes(const octafront_surface* surface, const octafront_options* options,
                                        int threads);
/** -> mesh: adapt_existing(), by the options' sizes. The report has "fit" and, of the old mesh, "fit_before". `ground`,
 * which may be null: the surface or domain that walls stand for. */
octafront_job* octafront_adapt(const octafront_mesh* mesh, const octafront_surface* ground,
                               const octafront_options* options, int threads);
/** -> mesh: adapt_to_metric(), by `n` symmetric matrices of 3 x 3, one for each point of the mesh, which must live
 * until the job has ended. The report as of octafront_adapt(). */
octafront_job* octafront_adapt_to_metric(const octafront_mesh* mesh, const octafront_surface* ground,
                                         const double* metric, size_t n, const octafront_options* options, int threads);
/** -> surface: adapt_surface(), or by `n` matrices, one for each of its points, adapt_surface_to_metric(); `metric` may
 * be null. The report as of octafront_adapt(). */
octafront_job* octafront_adapt_surface(const octafront_surface* surface, const octafront_surface* ground,
                                       const double* metric, size_t n, const octafront_options* options, int threads);
/** The functions of octafront/metric.h: {"task": "implied"}, {"task": "hessians"}, {"task": "of_field", "elements":
 * 1e5, "norm": 2, "gradation": 0.4, "min_size": 0, "max_size": 1}, {"task": "graded", "gradation": 0.4}, {"task":
 * "intersected"}, {"task": "bounded", "min_size": ...}, {"task": "with_complexity", "complexity": 1e4, ...}, {"task":
 * "complexity"}, which the report has. `values`: n matrices of 3 x 3, or of hessians and of_field n numbers; of
 * implied, null. `others`: the second metric that is intersected, or null. `out`: n matrices (implied: as many as the
 * mesh has points), or null. The mesh may be null where the task needs none. All must live until the job has ended. */
octafront_job* octafront_metrics(const octafront_mesh* mesh, const char* json, const double* values,
                                 const double* others, size_t n, double* out, int threads);
/** LevelSet of octafront/level_set.h: a value at each point of a mesh, and that of the surface. */
typedef struct {
  const char* name;
  const double* values;
  double level;
} octafront_level_set;
/** -> mesh: cut_along() of octafront/level_set.h, by the options' least_piece. The report has "level_sets". Level sets,
 * names and values must live until the job has ended. */
octafront_job* octafront_cut(const octafront_mesh* mesh, const octafront_level_set* level_sets, size_t count,
                             const octafront_options* options, int threads);
/** Values at the points of a mesh, or of its elements: `components` numbers for each. */
typedef struct {
  const char* name; /**< in reports */
  int of_elements;
  size_t components;
  const double* values; /**< on the old mesh */
  double* out;          /**< has room for those of the new mesh */
} octafront_field;
/** carry_fields() of octafront/carry.h, by the options' carry. `adapted` is 1 if octafront_adapt() or
 * octafront_improve() made the mesh `now` of `before`: then values go on linearly outside. The report has "carry" and
 * "carried". Fields, names and values must live until the job has ended. */
octafront_job* octafront_carry(const octafront_mesh* before, const octafront_mesh* now, int adapted,
                               const octafront_field* fields, size_t count, const octafront_options* options,
                               int threads);
/** -> mesh: move_mesh() of octafront/move.h, by three numbers for each point. The report has "history" and "notes". The
 * fields, whose `out` is not looked at, are on the new mesh what octafront_mesh_field() gives. All must live until the
 * job has ended.
 */
octafront_job* octafront_move(const octafront_mesh* mesh, const double* displacement, const octafront_field* fields,
                              size_t count, const octafront_options* options, int threads);
/** Of what octafront_move() left: the values of the i-th field that it was given, a row for each point or element. */
int octafront_mesh_field(const octafront_mesh* mesh, size_t i, octafront_array* values);
/** -> mesh: improve_existing(); `ground`, which may be null: the surface that the boundary slides on. */
octafront_job* octafront_improve(const octafront_mesh* mesh, const octafront_surface* ground,
                                 const octafront_options* options, int threads);
/** -> surface: repair_surface() and find_defects(), which the report lists. */
octafront_job* octafront_repair(const octafront_surface* surface);
/** -> surface: complex_of_walls() of octafront/complex.h, or a copy where the surface is a plain one; the report has
 * regions, with names and volumes, and notes. `json` is an object, all of whose keys may be missing: regions
 * ([["steel", [x, y, z]], ...]), voids ([[x, y, z], ...]), cells ("auto", "regions", "merge"), nested ("auto",
 * "cavity", "region"). A report of a failure may have `leak`, the way through a hole. */
octafront_job* octafront_complex_of_walls(const octafront_surface* surface, const char* json, int threads);
/** -> surface: join_bodies() of octafront/complex.h; bodies are copied. The same keys, and tolerance. */
octafront_job* octafront_join_bodies(const octafront_surface* const* bodies, const char* const* names, size_t count,
                                     const char* json, int threads);
/** -> surface: mend_surface() of octafront/mend.h, with its report. Keys: tolerance, way ("auto", "wrap"), distance. */
octafront_job* octafront_mend(const octafront_surface* surface, const char* json, int threads);
/** first_defect(), check_jacobians(), and by name of the solver, which may be null, check_for_solver(), in the report.
 */
octafront_job* octafront_check(const octafront_mesh* mesh, const char* solver);
/** -> mesh: in order, as readers do it: inverted tetrahedra turned, unused points dropped, missing boundary faces
 * added, regions and patches counted through. */
octafront_job* octafront_order_mesh(const octafront_mesh* mesh);
/** report_page() into a file, .html; `sizes` may be null, `report` is JSON, an object. */
octafront_job* octafront_write_page(const octafront_mesh* mesh, const octafront_sizes* sizes, const char* report,
                                    const char* file);

/** -> bytes: draw_picture() of octafront/picture.h as a PNG, of the mesh, or where that is null of the surface as it
 * is. `file`: it is written there, too; null: to none. Keys of `json`, an object, all of them optional: color, edges,
 * cut, view, up (texts, as `octafront picture` takes them), width, height (pixels), highlight (an array of places),
 * names, worst, furniture (true or false), title, unit (texts). The report has "width", "height" and "notes". */
octafront_job* octafront_picture(const octafront_mesh* mesh, const octafront_surface* surface, const char* json,
                                 const char* file, int threads);

/** Waits for the next event, `seconds` at most, below 0: as long as it takes. Returns its kind. */
int octafront_job_wait(octafront_job* job, double seconds, octafront_event* event);
/** 1, or 0 of a library that was built without threads (OCTAFRONT_THREADS=OFF), as for web pages. There a job does all
 * its work in the first octafront_job_wait(), whatever the seconds, and tells of it as it goes on by the watcher. */
int octafront_has_threads(void);
typedef void (*octafront_watcher)(void* data, const octafront_event* event);
/** Of a library without threads: calls `watcher` with each event but the end, inside octafront_job_wait(), which then
 * returns the end alone. It may cancel the job, and has filled in the sizes asked for when it returns; nothing else is
 * allowed to it. A library with threads never calls it. */
void octafront_job_watch(octafront_job* job, octafront_watcher watcher, void* data);
/** What the last OCTAFRONT_EVENT_SIZES, _GATHER or _EXCHANGE asked for is filled in. */
void octafront_job_answer(octafront_job* job);
/** The job ends soon, with OCTAFRONT_CANCELLED, and writes nothing; still wait for its end. */
void octafront_job_cancel(octafront_job* job);
void octafront_job_free(octafront_job* job);

/** Of a job that has ended. */
int octafront_job_status(const octafront_job* job);
/** What is wrong, or "". */
const char* octafront_job_message(const octafront_job* job);
/** JSON, an object: the report of what was done; of a job that failed its evidence: "defects" of a surface. */
const char* octafront_job_report(octafront_job* job);
/** The bytes that the job made, valid until it is freed; none: `length` is 0. */
const char* octafront_job_bytes(const octafront_job* job, size_t* length);
/** Each gives its object away, once; null if there is none. */
octafront_surface* octafront_job_take_surface(octafront_job* job);
octafront_mesh* octafront_job_take_mesh(octafront_job* job);
octafront_sizes* octafront_job_take_sizes(octafront_job* job);
octafront_image* octafront_job_take_image(octafront_job* job);

#ifdef __cplusplus
}
#endif

#endif
