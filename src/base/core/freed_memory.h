#pragma once

namespace octafront {

/// Gives memory that was freed back to the system, where there is much of it and the C library does not do so by
/// itself: glibc keeps what lies below an array that is still in use. To be called where much was freed and large
/// arrays are about to be made.
void return_freed_memory();

}  // namespace octafront
