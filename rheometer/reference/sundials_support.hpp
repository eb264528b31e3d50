#pragma once

// Ownership of SUNDIALS' C objects, and its return codes as exceptions. Private to rheometer/.

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <span>
#include <stdexcept>
#include <string>

namespace tremie {

inline void sundials_ok(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " failed with code " + std::to_string(flag));
}

struct SundialsContext {
  SUNContext get = nullptr;
  SundialsContext() { sundials_ok(SUNContext_Create(nullptr, &get), "SUNContext_Create"); }
  ~SundialsContext() { SUNContext_Free(&get); }
  SundialsContext(const SundialsContext&) = delete;
  SundialsContext& operator=(const SundialsContext&) = delete;
};

struct SundialsVector {
  N_Vector get = nullptr;
  SundialsVector(std::size_t size, const SundialsContext& context)
      : get(N_VNew_Serial(static_cast<sunindextype>(size), context.get)) {
    if (!get) throw std::bad_alloc();
  }
  ~SundialsVector() { N_VDestroy(get); }
  SundialsVector(const SundialsVector&) = delete;
  SundialsVector& operator=(const SundialsVector&) = delete;
};

inline std::span<double> values(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<std::size_t>(N_VGetLength(v))};
}

struct SundialsMatrix {
  SUNMatrix get = nullptr;
  explicit SundialsMatrix(SUNMatrix matrix) : get(matrix) {
    if (!get) throw std::bad_alloc();
  }
  ~SundialsMatrix() { SUNMatDestroy(get); }
  SundialsMatrix(const SundialsMatrix&) = delete;
  SundialsMatrix& operator=(const SundialsMatrix&) = delete;
};

struct SundialsLinearSolver {
  SUNLinearSolver get = nullptr;
  explicit SundialsLinearSolver(SUNLinearSolver solver) : get(solver) {
    if (!get) throw std::bad_alloc();
  }
  ~SundialsLinearSolver() { SUNLinSolFree(get); }
  SundialsLinearSolver(const SundialsLinearSolver&) = delete;
  SundialsLinearSolver& operator=(const SundialsLinearSolver&) = delete;
};

}  // namespace tremie
