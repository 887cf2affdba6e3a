#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "console/option_checks.h"
#include "console/progress_bar.h"
#include "design/certificate_proof.h"
#include "design/gain_file.h"
#include "design/rigorous_check.h"
#include "files/output_file.h"
#include "tools/design/claims.h"
#include "tools/design/commands.h"
#include "tools/design/gain_files.h"

namespace sampled_data_observers {
namespace {

struct VerifyArguments {
  std::string gains;
  std::vector<std::string> plant;
  bool is_rigorous = false;
  bool records = false;
  double time_limit = ProofOptions().time_limit;  // [s]
};

/// Conditions that hold and differ in their numbers only, as those at the nodes of a grid do: many
/// of them are told of by one, the one with the least value.
class RowsOfKinds {
 public:
  void add(std::size_t row, const std::string& name, double value) {
    Kind& kind = kinds_[kind_of(name)];
    if (kind.rows++ == 0 || value < kind.least) kind.least = value, kind.row = row;
  }
  /// How many rows this one stands for, itself included; 0 where another one stands for it.
  std::size_t stands_for(std::size_t row, const std::string& name) const {
    constexpr std::size_t kMany = 6;
    const Kind& kind = kinds_.at(kind_of(name));
    if (kind.rows <= kMany) return 1;
    return kind.row == row ? kind.rows : 0;
  }

 private:
  struct Kind {
    std::size_t rows = 0;
    std::size_t row = 0;
    double least = 0.0;
  };
  static std::string kind_of(std::string name) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    name.erase(std::remove_if(name.begin(), name.end(), is_digit), name.end());
    return name;
  }
  std::map<std::string, Kind> kinds_;
};

void print_rest(std::size_t rows) {
  if (rows > 1) std::printf("; and %zu more of its kind", rows - 1);
  std::printf("\n");
}

void verify_in_floating_point(const Certificate& certificate) {
  const auto checks = check(certificate);
  RowsOfKinds kinds;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    if (checks[i].holds()) kinds.add(i, checks[i].name, checks[i].min_eigenvalue);
  }
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const ConditionCheck& check = checks[i];
    const std::size_t rows = check.holds() ? kinds.stands_for(i, check.name) : 1;
    if (rows == 0) continue;
    std::printf("  %-9s %s", check.holds() ? "holds" : "VIOLATED", check.name.c_str());
    if (check.kind == Condition::Kind::kDefinite) {
      std::printf(", least eigenvalue %.3g (scaled, rounding %.1e)", check.min_eigenvalue,
                  check.rounding);
    } else {
      std::printf(", by %.6g", std::abs(check.min_eigenvalue));
    }
    if (check.tau) std::printf(" at tau = %.6g s", *check.tau);
    print_rest(rows);
  }
  if (!all_hold(checks)) throw ExitStatus{kNotVerified};
}

/// Returns the number of conditions, all of which are proved.
std::size_t verify_rigorously(const Certificate& certificate, double time_limit) {
  const auto conditions = certificate.theorem->conditions(certificate.subject);
  std::vector<ConditionProof> proofs;
  {
    constexpr std::size_t kSteps = 1000;
    ProgressBar progress("verify", kSteps);
    ProofOptions options;
    options.time_limit = time_limit;
    options.on_progress = [&](double share) {
      progress.advance_to(static_cast<std::size_t>(share * static_cast<double>(kSteps)));
    };
    proofs = prove(certificate, options);
  }
  bool is_disproved = false;
  bool is_undecided = false;
  RowsOfKinds kinds;
  for (std::size_t i = 0; i < proofs.size(); ++i) {
    if (proofs[i].status == ProofStatus::kProved) kinds.add(i, proofs[i].name, 0.0);
  }
  for (std::size_t i = 0; i < proofs.size(); ++i) {
    const ConditionProof& proof = proofs[i];
    const bool is_proved = proof.status == ProofStatus::kProved;
    const std::size_t rows = is_proved ? kinds.stands_for(i, proof.name) : 1;
    if (rows == 0) continue;
    std::printf("  %-9s %s", to_string(proof.status), proof.name.c_str());
    switch (proof.status) {
      case ProofStatus::kProved:
        if (proof.intervals > 1) std::printf(", on %zu intervals of tau", proof.intervals);
        break;
      case ProofStatus::kDisproved:
        is_disproved = true;
        std::printf(conditions[i].is_domain() ? ", by %.17g" : ", an eigenvalue <= %.17g",
                    proof.value);
        if (proof.tau) std::printf(" at tau = %.17g s", *proof.tau);
        break;
      case ProofStatus::kUndecided:
        is_undecided = true;
        std::printf(": %s", proof.reason.c_str());
        break;
    }
    print_rest(rows);
  }
  if (is_disproved) throw ExitStatus{kNotVerified};
  if (is_undecided) throw ExitStatus{kUndecided};
  std::printf("all %zu conditions are proved\n", proofs.size());
  return proofs.size();
}

void record_proof(const std::string& file, const CertificateConfig& claim, std::size_t conditions) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::string recorded;
  try {
    recorded =
        with_proof_record(text.str(), claim.section, proof_record(claim.certificate, conditions));
  } catch (const std::invalid_argument& fault) {
    throw std::runtime_error(file + ": " + claim.section + ": " + fault.what());
  }
  write_output(file, recorded);
  std::printf("recorded in %s\n", file.c_str());
}

void verify_command(const VerifyArguments& arguments) {
  for (const CertificateConfig& claim :
       read_claims(arguments.gains, plant_files_of(arguments.gains, arguments.plant))) {
    if (claim.section == kRunTimeCertificate) {
      std::printf("for the error bound at run time (%s):\n", kRunTimeCertificate);
    }
    std::printf("%s\n", statement(claim.certificate).c_str());
    if (arguments.is_rigorous) {
      const std::size_t proved = verify_rigorously(claim.certificate, arguments.time_limit);
      if (arguments.records) record_proof(arguments.gains, claim, proved);
    } else {
      verify_in_floating_point(claim.certificate);
    }
  }
}

}  // namespace

void add_verify(CommandLine& tool) {
  CommandLine& command =
      tool.command("verify", "Check the original inequalities of a gain file's theorem");
  auto arguments = std::make_shared<VerifyArguments>();
  command.argument("GAINS", arguments->gains, "Gain file");
  command.option("--plant PLANT...", arguments->plant,
                 "Files with the plant, instead of the one that the gain file names");
  const Option& rigorous =
      command.flag("--rigorous", arguments->is_rigorous,
                   "Prove or disprove them in ball arithmetic, for all tau and for the decimals in "
                   "the files, instead of a check in floating point");
  command
      .flag("--record", arguments->records,
            "Write into the gain file that all is proved, as 'synthesize' does")
      .needs(rigorous);
  command
      .option("--time-limit SECONDS", arguments->time_limit,
              "With --rigorous: what is not decided after this time [s] is undecided")
      .check(number_above(0));
  command.action([arguments] {
    verify_command(*arguments);
    return 0;
  });
}

}  // namespace sampled_data_observers
