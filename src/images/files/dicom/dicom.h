#pragma once

// image/dicom: files of the DICOM standard. It takes slices, in one file or in many of a folder, and leaves one volume:
// tells series apart, sorts slices along their normal, and keeps unequal distances and the shear of a tilted gantry.
//
// elements.h  what stands in a file
// slices.h    one file: its images and where they lie
// series.h    slices to volumes

#include "images/files/dicom/series.h"
