#include <algorithm>

#include <cholmod.h>
#include <dlfcn.h>

#include "physics/linear/cholesky.hpp"

namespace selvedge {
namespace {

// A multi-threaded BLAS is slower than one thread on matrices of this size. The function is looked up at run time,
// since the machine decides which BLAS CHOLMOD uses.
void hold_blas_to_one_thread() {
  using SetThreads = void (*)(int);
  for (const char* name : {"openblas_set_num_threads", "bli_thread_set_num_threads"})
    if (void* found = dlsym(RTLD_DEFAULT, name)) reinterpret_cast<SetThreads>(found)(1);
}

// For its lifetime CHOLMOD starts no threads. CHOLMOD asks for a team of four whatever the limit of threads; on two
// cores such a team spins, and each time displaces our own. The functions are looked up at run time, since CHOLMOD may
// use OpenMP where this build does not.
class OneThread {
 public:
  OneThread() : levels_(get_ ? get_() : 0) {
    if (set_) set_(0);
  }
  ~OneThread() {
    if (set_) set_(levels_);
  }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int (*get_)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
  void (*set_)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
  int levels_;
};

}  // namespace

struct Cholesky::Impl {
  cholmod_common common{};
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;  // the simplicial kind accepts indefinite matrices
    common.error_handler = nullptr;
  }
  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
};

Cholesky::Cholesky() : impl_(std::make_unique<Impl>()) {}
Cholesky::~Cholesky() = default;
bool Cholesky::available() { return true; }

bool Cholesky::analyse(int size, std::span<int> column_begin, std::span<int> row) {
  hold_blas_to_one_thread();
  cholmod_sparse& matrix = impl_->matrix;
  matrix = {};
  matrix.nrow = matrix.ncol = static_cast<std::size_t>(size);
  matrix.nzmax = row.size();
  matrix.p = column_begin.data();
  matrix.i = row.data();
  matrix.stype = -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_PATTERN;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = 1;
  matrix.packed = 1;
  cholmod_free_factor(&impl_->factor, &impl_->common);
  impl_->factor = cholmod_analyze(&matrix, &impl_->common);
  return impl_->factor != nullptr;
}

bool Cholesky::factor(std::span<double> values) {
  if (!impl_->factor) return false;
  impl_->matrix.x = values.data();
  impl_->matrix.xtype = CHOLMOD_REAL;
  const OneThread alone;
  cholmod_factorize(&impl_->matrix, impl_->factor, &impl_->common);
  return impl_->common.status == CHOLMOD_OK && impl_->factor->minor == impl_->factor->n;
}

bool Cholesky::solve(std::span<double> right, std::span<double> solution) {
  if (!impl_->factor) return false;
  cholmod_dense dense{};
  dense.nrow = dense.d = dense.nzmax = right.size();
  dense.ncol = 1;
  dense.x = right.data();
  dense.xtype = CHOLMOD_REAL;
  dense.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* result = cholmod_solve(CHOLMOD_A, impl_->factor, &dense, &impl_->common);
  if (!result) return false;
  std::copy_n(static_cast<const double*>(result->x), solution.size(), solution.begin());
  cholmod_free_dense(&result, &impl_->common);
  return true;
}

}  // namespace selvedge
