#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <ostream>
#include <sstream>
#include <system_error>
#include <thread>

#include "design/lmi_solver.h"
#include "design/standard_form.h"

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A folder for the files of one run.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = (fs::temp_directory_path() / "sdpa-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) {
      throw std::system_error(errno, std::generic_category(), path);
    }
    path_ = path;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// The SDPA sparse format; its F_0 has the opposite sign.
void write_problem(const StandardForm& form, std::ostream& out) {
  out.imbue(std::locale::classic());
  out.precision(17);
  out << form.objective.size() << '\n' << form.blocks.size() << '\n';
  for (const AffineMatrix& block : form.blocks) out << block.constant.rows() << ' ';
  out << '\n';
  for (const double coefficient : form.objective) out << coefficient << ' ';
  out << '\n';
  for (std::size_t b = 0; b < form.blocks.size(); ++b) {
    const auto write = [&](std::size_t matrix, int row, int col, double value) {
      if (value == 0.0) return;
      out << matrix << ' ' << b + 1 << ' ' << row + 1 << ' ' << col + 1 << ' ' << value << '\n';
    };
    const Eigen::MatrixXd& constant = form.blocks[b].constant;
    for (int i = 0; i < constant.rows(); ++i) {
      for (int j = i; j < constant.cols(); ++j) {
        write(0, i, j, -(constant(i, j) + constant(j, i)) / 2.0);
      }
    }
    const auto triangles = triangles_of(form.blocks[b], form.objective.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      for (const auto& [at, value] : triangles[k]) write(k + 1, at.first, at.second, value);
    }
  }
}

void write_problem(const StandardForm& form, const std::string& file) {
  std::ofstream out(file);
  write_problem(form, out);
  out.close();
  if (!out) throw std::system_error(errno, std::generic_category(), file);
}

/// The program's defaults but for the digits of x, and for bounds on the objective that are never
/// met.
void write_parameters(const std::string& file) {
  std::ofstream(file) << "100 maxIteration\n1.0e-7 epsilonStar\n1.0e2 lambdaStar\n"
                         "2.0 omegaStar\n-1.0e20 lowerBound\n1.0e20 upperBound\n"
                         "0.1 betaStar\n0.2 betaBar\n0.9 gammaStar\n1.0e-7 epsilonDash\n"
                         "%+.17e xPrint\nNOPRINT XPrint\nNOPRINT YPrint\n%+.17e infPrint\n";
}

/// Ends with the exit status of the process, or with −1 where it was ended at the time limit.
/// @throws std::system_error where it can't be started
int run(const std::vector<std::string>& command, double time_limit) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  // Its matrices are small: threads would mostly wait for each other, on a busy machine for long.
  std::string one_thread[] = {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"};
  std::vector<char*> environment = {one_thread[0].data(), one_thread[1].data()};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    environment.push_back(*variable);
  }
  environment.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  pid_t pid = 0;
  const int fault = ::posix_spawnp(&pid, arguments.front(), &actions, nullptr, arguments.data(),
                                   environment.data());
  ::posix_spawn_file_actions_destroy(&actions);
  if (fault != 0) throw std::system_error(fault, std::generic_category(), command.front());
  const auto start = Clock::now();
  int status = 0;
  while (::waitpid(pid, &status, WNOHANG) == 0) {
    if (std::chrono::duration<double>(Clock::now() - start).count() > time_limit) {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return status;
}

/// What stands after "key = ", up to white space; empty where it is not there.
std::string text_after(const std::string& output, const std::string& key) {
  std::size_t at = output.rfind(key);
  if (at == std::string::npos) return "";
  at = output.find_first_not_of(" =\n", at + key.size());
  return output.substr(at, output.find_first_of(" \n", at) - at);
}

std::vector<double> numbers_between_braces(const std::string& output, const std::string& key) {
  std::vector<double> numbers;
  const std::size_t open = output.find('{', output.rfind(key));
  if (output.rfind(key) == std::string::npos || open == std::string::npos) return numbers;
  std::string list = output.substr(open + 1, output.find('}', open) - open - 1);
  for (char& c : list) c = c == ',' ? ' ' : c;
  const char* at = list.c_str();
  for (char* end = nullptr;; at = end) {
    const double value = std::strtod(at, &end);
    if (end == at) return numbers;
    numbers.push_back(value);
  }
}

SolverStatus status_of(const std::string& phase) {
  if (phase == "pdOPT") return SolverStatus::kSolved;
  if (phase == "pINF_dFEAS" || phase == "pdINF") return SolverStatus::kInfeasible;
  if (phase == "pFEAS_dINF" || phase == "pUNBD") return SolverStatus::kUnbounded;
  if (phase == "pdFEAS" || phase == "pFEAS") return SolverStatus::kInaccurate;
  return SolverStatus::kFailed;
}

}  // namespace

std::string sdpa_problem(const LmiProgram& program, const SolverOptions& options) {
  const std::vector<LmiProgram::Block> blocks = program.compile();
  const StandardForm form = standard_form(program, blocks, options);
  std::ostringstream out;
  out << "* variables, column by column of each matrix\n";
  for (const std::string& line : program.describe_variables()) out << "* " << line << '\n';
  if (!program.has_objective()) {
    out << "* x" << form.objective.size() << ": how far the solution is inside the strict blocks\n";
  }
  std::size_t number = 0;
  for (const LmiProgram::Block& block : blocks) {
    if (block.matrix.is_constant()) continue;  // left out, as in the standard form
    out << "* block " << ++number << ": " << block.name << '\n';
  }
  write_problem(form, out);
  return out.str();
}

LmiSolution solve_with_sdpa(const LmiProgram& program, double time_limit,
                            const SolverOptions& options) {
  const auto start = Clock::now();
  LmiSolution solution;
  solution.solver = "SDPA";
  const std::vector<LmiProgram::Block> blocks = program.compile();
  const StandardForm form = standard_form(program, blocks, options);
  const TemporaryFolder folder;
  const std::string result = folder.file("result");
  write_problem(form, folder.file("problem.dat-s"));
  write_parameters(folder.file("parameters"));
  try {
    solution.return_code = run({"sdpa", "-ds", folder.file("problem.dat-s"), "-o", result, "-p",
                                folder.file("parameters")},
                               time_limit);
  } catch (const std::system_error& error) {
    solution.message = "the program 'sdpa' can't be run (" + error.code().message() +
                       "): install Debian's package sdpa, or, where there is none as in Debian 13, "
                       "SDPA from its sources";
    return solution;
  }
  solution.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (solution.return_code == -1) {
    solution.status = SolverStatus::kTimedOut;
    solution.message = "sdpa was ended at its time limit";
    return solution;
  }
  std::ifstream file(result);
  const std::string output{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  solution.message = text_after(output, "phase.value");
  solution.status = solution.message.empty() ? SolverStatus::kCrashed : status_of(solution.message);
  if (solution.message.empty()) solution.message = "sdpa ended without a result";
  // Its primal is the program, as the other solver's dual is.
  solution.dual_objective = std::strtod(text_after(output, "objValPrimal").c_str(), nullptr);
  solution.primal_objective = std::strtod(text_after(output, "objValDual").c_str(), nullptr);
  const std::vector<double> x = numbers_between_braces(output, "xVec");
  if (x.size() == form.objective.size()) take_variables(program, blocks, x, solution);
  return solution;
}

}  // namespace sampled_data_observers
