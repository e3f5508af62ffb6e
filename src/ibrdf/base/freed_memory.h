// What becomes of memory that is freed.
#pragma once

namespace ibrdf {

// Has the allocator keep up to 256 MB of what is freed, and ask the system for
// blocks above 32 MB alone. A solver makes and frees matrices of megabytes
// thousands of times; given back in between, their pages are zeroed each time,
// which took half the time of a search's dense algebra. For programs: it is a
// setting of the process. Does nothing where the C library is not GNU's.
void KeepFreedMemory();

}  // namespace ibrdf
