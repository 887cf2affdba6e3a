#include "observer/constant_gain_observer.h"

#include <gtest/gtest.h>

#include "support/random_events.h"

namespace sampled_data_observers {
namespace {

class ConstantGainObserverTest : public ::testing::Test {
 protected:
  void SetUp() override {
    law_->initialize(state_.data());
    EXPECT_EQ(Eigen::Vector3d(0.3, -0.2, 3.0), estimate());
  }
  Eigen::Vector3d estimate() const { return state_.head(3); }
  void reset(const test::OwnedEvent& event) {
    law_->reset(event.view(), state_.data(), workspace_.data());
  }

  std::shared_ptr<const ConstantGainObserver> law_ = test::example_law();
  Eigen::VectorXd state_ = Eigen::VectorXd(law_->state_size());
  Eigen::VectorXd workspace_ = Eigen::VectorXd(law_->workspace_size());
};

TEST_F(ConstantGainObserverTest, ASampleAddsTheGainTimesTheInnovation) {
  reset({1, EventKind::kSample, 0, {1.3}});
  const Eigen::Vector3d expected =
      Eigen::Vector3d(0.3, -0.2, 3.0) + Eigen::Vector3d(0.6, 0.4, 0.05) * (1.3 - 0.3);
  EXPECT_LT((expected - estimate()).norm(), 1e-15);
}

TEST_F(ConstantGainObserverTest, TheInnovationOfAnAngleIsWrapped) {
  // C x = (0.2, 3.0); an angle of -3 is 2 pi - 6 away.
  reset({1, EventKind::kSample, 1, {0.2, -3.0}});
  const double innovation = 2.0 * 3.14159265358979323846 - 6.0;
  EXPECT_NEAR(3.0 + 0.7 * innovation, estimate()(2), 1e-15);
  EXPECT_NEAR(-0.2 + 0.1 * innovation, estimate()(1), 1e-15);
  EXPECT_NEAR(0.3, estimate()(0), 1e-15);
}

TEST_F(ConstantGainObserverTest, AJumpIsThePlants) {
  reset({1, EventKind::kJump, 0, {}});
  EXPECT_LT((Eigen::Vector3d(0.3, 0.26, 3.0) - estimate()).norm(), 1e-15);
}

TEST_F(ConstantGainObserverTest, FlowsAsThePlantUnderTheInputHeld) {
  reset({1, EventKind::kInput, 0, {2.0, -1.0}});
  Eigen::Vector3d expected(0.3, -0.2, 3.0);
  const double u[] = {2.0, -1.0};
  Eigen::Vector3d scratch;
  const AffineMap& f = *law_->plant().modes().front().flow->affine();
  LinearFlow(f.M(), f.N()).apply(123456789, expected.data(), u, scratch.data());
  law_->flow(123456789, state_.data(), workspace_.data());
  EXPECT_EQ(expected, estimate());
}

TEST_F(ConstantGainObserverTest, KnowsItsChannels) {
  EXPECT_EQ(1, law_->event_size(EventKind::kSample, 0));
  EXPECT_EQ(2, law_->event_size(EventKind::kSample, 1));
  EXPECT_EQ(-1, law_->event_size(EventKind::kSample, 2));
  EXPECT_FALSE(law_->accepts({1, EventKind::kSample, -1, nullptr, 1}));
  EXPECT_EQ(2, law_->event_size(EventKind::kInput, 0));
  EXPECT_EQ(0, law_->event_size(EventKind::kJump, 0));
  EXPECT_EQ(2, law_->max_event_size());
}

TEST_F(ConstantGainObserverTest, RefusesGainsThatDoNotFit) {
  const Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(2);
  LinearPlantDescription description;
  description.state_names = law_->plant().state_names();
  description.input_names = law_->plant().input_names();
  description.A = Eigen::MatrixXd::Zero(3, 3);
  description.B = Eigen::MatrixXd::Zero(3, 2);
  description.sensors = {{"a", Eigen::MatrixXd::Zero(1, 3), {false}},
                         {"b", Eigen::MatrixXd::Zero(2, 3), {false, false}}};
  const auto plant = make_linear_plant(description);
  const ObserverContext context{plant, x, u};
  const std::vector<Eigen::MatrixXd> good = {Eigen::MatrixXd(3, 1), Eigen::MatrixXd(3, 2)};
  EXPECT_NO_THROW(ConstantGainObserver(context, good));
  EXPECT_THROW(ConstantGainObserver(context, {good[0]}), std::invalid_argument);
  EXPECT_THROW(ConstantGainObserver(context, {good[1], good[0]}), std::invalid_argument);
  EXPECT_THROW(ConstantGainObserver({plant, u, u}, good), std::invalid_argument);
  EXPECT_THROW(ConstantGainObserver({plant, x, x}, good), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
