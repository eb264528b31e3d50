#pragma once

// OpenMP for one thread, where the compiler has none; its pragmas are left out.

inline void omp_set_num_threads(int) {}
inline int omp_get_max_threads() { return 1; }
