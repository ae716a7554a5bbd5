#pragma once

// What passes between this process and the system: the pages of its memory.

#include <cstddef>

namespace octafront {

/// Gives memory that was freed back to the system, where there is much of it and the C library does not do so by
/// itself: glibc keeps what lies below an array that is still in use. To be called where much was freed and large
/// arrays are about to be made.
void return_freed_memory();

/// Takes the pages of memory that is about to be written from the system, by all threads; nothing where the system
/// cannot. What stands there stays.
void take_pages(void* begin, std::size_t bytes);

}  // namespace octafront
