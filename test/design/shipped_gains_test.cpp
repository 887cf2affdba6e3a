// Every gain file with a certificate that the package ships: proved in ball arithmetic, and
// disproved with a gain that is changed enough.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "certificate/certified_gains.h"
#include "design/rigorous_check.h"

namespace sampled_data_observers::test {
namespace {

/// FILE:SECTION, the file relative to the repository.
std::vector<std::string> claims() {
  const std::filesystem::path root = SDO_SOURCE_DIR;
  std::vector<std::string> all;
  for (const char* folder : {"config", "test/certificate"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      const ConfigNode file = read_yaml_file(entry.path().string());
      for (const char* section : {kCertificate, kRunTimeCertificate}) {
        if (file.find(section) == nullptr) continue;
        all.push_back(std::filesystem::relative(entry.path(), root).string() + ":" + section);
      }
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

bool any(const std::vector<ConditionProof>& proofs, ProofStatus status) {
  return std::any_of(proofs.begin(), proofs.end(),
                     [status](const ConditionProof& proof) { return proof.status == status; });
}

class ShippedGainsTest : public ::testing::TestWithParam<std::string> {
 protected:
  ShippedGainsTest() : certificate_(CertifiedGains(file()).certificate(section())) {}

  std::string file() const { return GetParam().substr(0, GetParam().find(':')); }
  std::string section() const { return GetParam().substr(GetParam().find(':') + 1); }

  const Certificate certificate_;
  const std::vector<Condition> conditions_ = certificate_.theorem->conditions(certificate_.subject);
};

TEST_P(ShippedGainsTest, AreProved) {
  for (const Condition& condition : conditions_) {
    EXPECT_EQ(first_unproved(prove({condition}, certificate_.values)), "") << condition.name;
  }
}

TEST_P(ShippedGainsTest, RecordTheirProof) {
  EXPECT_TRUE(CertifiedGains(file()).claim(section())->is_proved);
}

TEST_P(ShippedGainsTest, AreDisprovedWithANegativeNumber) {
  const Theorem& theorem = *certificate_.theorem;
  const CertificateSubject& subject = certificate_.subject;
  for (const auto& shapes :
       {theorem.gains(subject), theorem.multipliers(subject), theorem.parameters(subject)}) {
    for (const NamedShape& shape : shapes) {
      if (shape.form != NamedShape::Form::kScalar) continue;
      NamedMatrices values = certificate_.values;
      values.at(shape.name)(0, 0) = -std::abs(values.at(shape.name)(0, 0)) - 1e-9;
      EXPECT_FALSE(all_hold(check(conditions_, values))) << shape.name;
      EXPECT_TRUE(any(prove(conditions_, values), ProofStatus::kDisproved)) << shape.name;
    }
  }
}

TEST_P(ShippedGainsTest, AreDisprovedWithAChangedEntry) {
  const NamedShape gain = certificate_.theorem->gains(certificate_.subject).front();
  NamedMatrices values = certificate_.values;
  double change = 1e-3;
  for (; change < 1e4; change *= 2.0) {
    values.at(gain.name) = certificate_.values.at(gain.name);
    values.at(gain.name)(0, 0) -= change;
    if (!all_hold(check(conditions_, values))) break;
  }
  ASSERT_FALSE(all_hold(check(conditions_, values)));
  // Away from the edge, where nothing can be decided.
  values.at(gain.name)(0, 0) -= change;
  EXPECT_TRUE(any(prove(conditions_, values), ProofStatus::kDisproved));
}

INSTANTIATE_TEST_SUITE_P(
    All, ShippedGainsTest, ::testing::ValuesIn(claims()), [](const auto& info) {
      std::string name = info.param;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

TEST(ShippedGains, AreThoseOfAllPapers) { EXPECT_GE(claims().size(), 24u); }

}  // namespace
}  // namespace sampled_data_observers::test
