#pragma once

// images/files: voxels. It takes files of CT, MRI and segmentations and leaves an Image behind: a grid with its map
// to the world and one finite number per voxel; then, of whole numbers, a LabelImage. Readers believe nothing that a
// file says about itself before its bytes bear it out.
//
// One file per format (read_nifti.cpp); image_files.cpp has the one table of formats. To add one: a reader and a test
// of the first bytes in readers.h, a line in that table.
//
// byte_source.h  bytes one after another, unpacked on the way
// voxels.h       bytes to numbers
// grids.h        what sizes and axes must fulfil
