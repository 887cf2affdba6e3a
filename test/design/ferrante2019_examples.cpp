#include "ferrante2019_examples.h"

namespace sampled_data_observers::test {
namespace {

CertificateSubject sampled_subject(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, double T2) {
  CertificateSubject subject;
  ModeMatrices mode;
  mode.A = A;
  mode.C = C;
  subject.plant.modes = {mode};
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    subject.plant.state_names.push_back("z" + std::to_string(i + 1));
  }
  subject.plant.G.resize(A.rows(), 0);
  subject.plant.S.resize(0, A.rows());
  subject.T1 = T2 / 2.0;
  subject.T2 = T2;
  return subject;
}

}  // namespace

CertificateSubject oscillator(double T2) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -4, 0;
  CertificateSubject subject = sampled_subject(A, Eigen::MatrixXd::Identity(1, 2), T2);
  subject.plant.N = Eigen::MatrixXd::Identity(2, 1);
  subject.plant.C_p = Eigen::MatrixXd::Identity(2, 2);
  return subject;
}

CertificateSubject unicycle(double T2) {
  Eigen::MatrixXd A(3, 3);
  A << 0, 1, 0, 0, -0.01, 0, 1, 0, 0;
  Eigen::MatrixXd C(2, 3);
  C << 1, 0, 0, 0, 0, 1;
  CertificateSubject subject = sampled_subject(A, C, T2);
  subject.plant.N = Eigen::MatrixXd::Zero(3, 1);
  subject.plant.N(1, 0) = 1.0;
  subject.plant.C_p = subject.plant.N.transpose();
  return subject;
}

CertificateSubject flexible_link(double T2, int performance_outputs) {
  Eigen::MatrixXd A(4, 4);
  A << 0, 1, 0, 0, -48.6, -1.25, 48.6, 0, 0, 0, 0, 1, 19.5, 0, -19.5, 0;
  CertificateSubject subject = sampled_subject(A, Eigen::MatrixXd::Identity(2, 4), T2);
  PlantMatrices& plant = subject.plant;
  plant.G = Eigen::MatrixXd::Zero(4, 1);
  plant.G(3, 0) = -1.0;
  plant.S = Eigen::MatrixXd::Zero(1, 4);
  plant.S(0, 2) = 1.0;
  plant.lipschitz_constant = 3.3;
  plant.N = Eigen::MatrixXd::Zero(4, 1);
  plant.N(1, 0) = 1.0;
  plant.C_p = Eigen::MatrixXd::Identity(4, 4).middleRows(2, performance_outputs);
  return subject;
}

}  // namespace sampled_data_observers::test
