#include <csdp/declarations.h>
#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <new>
#include <utility>

#include "design/lmi_solver.h"
#include "design/standard_form.h"

namespace sampled_data_observers {
namespace {

template <class T>
T* allocate(std::size_t count) {
  // The solver frees what it is given.
  auto* memory = static_cast<T*>(std::calloc(std::max<std::size_t>(count, 1), sizeof(T)));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

blockmatrix make_C(const StandardForm& form) {
  blockmatrix C{};
  C.nblocks = static_cast<int>(form.blocks.size());
  C.blocks = allocate<blockrec>(form.blocks.size() + 1);
  for (std::size_t b = 0; b < form.blocks.size(); ++b) {
    const Eigen::MatrixXd& constant = form.blocks[b].constant;
    blockrec& block = C.blocks[b + 1];
    block.blockcategory = MATRIX;
    block.blocksize = static_cast<int>(constant.rows());
    block.data.mat = allocate<double>(static_cast<std::size_t>(constant.size()));
    for (Eigen::Index j = 0; j < constant.cols(); ++j) {
      for (Eigen::Index i = 0; i < constant.rows(); ++i) {
        block.data.mat[j * constant.rows() + i] = -(constant(i, j) + constant(j, i)) / 2.0;
      }
    }
  }
  return C;
}

constraintmatrix* make_constraints(const StandardForm& form) {
  const std::size_t variables = form.objective.size();
  auto* constraints = allocate<constraintmatrix>(variables + 1);
  // Each list begins with the last block.
  for (std::size_t b = form.blocks.size(); b-- > 0;) {
    const std::vector<TriangleEntries> entries = triangles_of(form.blocks[b], variables);
    for (std::size_t k = 0; k < variables; ++k) {
      if (entries[k].empty()) continue;
      auto* block = allocate<sparseblock>(1);
      block->blocknum = static_cast<int>(b) + 1;
      block->blocksize = static_cast<int>(form.blocks[b].constant.rows());
      block->constraintnum = static_cast<int>(k) + 1;
      block->entries = allocate<double>(entries[k].size() + 1);
      block->iindices = allocate<int>(entries[k].size() + 1);
      block->jindices = allocate<int>(entries[k].size() + 1);
      for (const auto& [at, value] : entries[k]) {
        if (value == 0.0) continue;
        const int position = ++block->numentries;
        block->entries[position] = value;
        block->iindices[position] = at.first + 1;
        block->jindices[position] = at.second + 1;
      }
      block->issparse = block->numentries <= block->blocksize / 4 ? 1 : 0;
      block->next = constraints[k + 1].blocks;
      constraints[k + 1].blocks = block;
    }
  }
  return constraints;
}

/// The meaning of CSDP's return codes. Its dual is our program.
std::pair<SolverStatus, const char*> meaning_of(int code) {
  switch (code) {
    case 0:
      return {SolverStatus::kSolved, "solved"};
    case 1:
      return {SolverStatus::kUnbounded, "the objective is not bounded below"};
    case 2:
      return {SolverStatus::kInfeasible, "the inequalities contradict each other"};
    case 3:
      return {SolverStatus::kInaccurate, "solved with reduced accuracy"};
    case 4:
      return {SolverStatus::kInaccurate, "the maximum number of iterations was reached"};
    case 5:
      return {SolverStatus::kInaccurate, "stuck at the edge of primal feasibility"};
    case 6:
      return {SolverStatus::kInaccurate, "stuck at the edge of dual feasibility"};
    case 7:
      return {SolverStatus::kInaccurate, "lack of progress"};
    case 8:
      return {SolverStatus::kFailed, "a matrix became singular"};
    default:
      return {SolverStatus::kFailed, "numbers overflowed"};
  }
}

/// The solver and its linear algebra start threads of their own where they are built so. Workers
/// are as many as processors already.
void use_one_thread() {
  using SetThreads = void (*)(int);
  for (const char* name : {"openblas_set_num_threads", "omp_set_num_threads"}) {
    const auto set_threads = reinterpret_cast<SetThreads>(::dlsym(RTLD_DEFAULT, name));
    if (set_threads != nullptr) set_threads(1);
  }
}

}  // namespace

LmiSolution solve_with_csdp(const LmiProgram& program, const SolverOptions& options) {
  use_one_thread();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<LmiProgram::Block> blocks = program.compile();
  const StandardForm form = standard_form(program, blocks, options);
  const auto variables = static_cast<int>(form.objective.size());
  int n = 0;
  for (const AffineMatrix& block : form.blocks) n += static_cast<int>(block.constant.rows());

  blockmatrix C = make_C(form);
  constraintmatrix* constraints = make_constraints(form);
  auto* a = allocate<double>(static_cast<std::size_t>(variables) + 1);
  std::copy(form.objective.begin(), form.objective.end(), a + 1);
  blockmatrix X{};
  blockmatrix Z{};
  double* y = nullptr;

  LmiSolution solution;
  solution.solver = "CSDP";
  initsoln(n, variables, C, a, constraints, &X, &y, &Z);
  solution.return_code = easy_sdp(n, variables, C, a, constraints, 0.0, &X, &y, &Z,
                                  &solution.primal_objective, &solution.dual_objective);
  std::tie(solution.status, solution.message) = meaning_of(solution.return_code);
  const std::vector<double> x(y + 1, y + 1 + variables);
  free_prob(n, variables, C, a, constraints, X, y, Z);

  take_variables(program, blocks, x, solution);
  solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

}  // namespace sampled_data_observers
