#include "models/excavator/kinematic_tree.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "models/excavator/machine_model.hpp"
#include "tests/models/excavator/random_posture.hpp"

namespace wex {
namespace {

constexpr unsigned kSeed = 7;
constexpr int kPostures = 20;
constexpr double kStep = 1e-6;  // rad or m, central differences
// Lengths are up to 15 m, so central differences are good to about 1e-9 m.
constexpr double kJacobianToleranceM = 1e-7;
constexpr double kHessianToleranceM = 1e-6;

using Value = std::function<Eigen::Vector3d(const Eigen::VectorXd&)>;
using Jacobian = std::function<Eigen::Matrix3Xd(const Eigen::VectorXd&)>;
using Hessian = std::function<Eigen::MatrixXd(const Eigen::VectorXd&, const Eigen::Vector3d&)>;

// A tree with everything the formulas distinguish: prismatic joints above and below revolute ones,
// two joints of one coordinate on one chain and a third on another, a locked joint, slanted axes.
KinematicTree awkward_tree() {
  std::mt19937 generator(kSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto random_vector = [&] {
    return Eigen::Vector3d(unit(generator), unit(generator), unit(generator));
  };
  const auto body = [&](int parent, int coordinate, double multiplier, bool prismatic) {
    KinematicTree::Body b;
    b.name = "body";
    b.parent = parent;
    b.coordinate = coordinate;
    b.multiplier = multiplier;
    b.prismatic = prismatic;
    b.offset = 0.3 * unit(generator);
    b.axis = random_vector();
    b.T_parent_joint.translation() = random_vector();
    b.T_parent_joint.linear() =
        Eigen::AngleAxisd(unit(generator), random_vector().normalized()).toRotationMatrix();
    b.mass_kg = 2.0 + unit(generator);
    b.p_body_com = random_vector();
    return b;
  };
  std::vector<KinematicTree::Body> bodies{body(-1, -1, 1.0, false)};
  bodies.push_back(body(0, 6, 1.0, false));
  bodies.push_back(body(1, 7, 1.0, true));
  bodies.push_back(body(2, 6, -1.0, false));  // follows the first on the same chain
  bodies.push_back(body(3, 8, 0.5, false));
  bodies.push_back(body(4, -1, 1.0, false));  // locked
  bodies.push_back(body(5, 7, 2.0, true));    // prismatic mimic below
  bodies.push_back(body(1, 9, 1.0, false));   // second branch
  bodies.push_back(body(7, 8, -0.7, false));  // shares a coordinate across branches
  return KinematicTree(bodies, 10);
}

void expect_derivatives_match(const Value& value, const Jacobian& jacobian, const Hessian& hessian,
                              const Eigen::VectorXd& q, const Eigen::Vector3d& weights) {
  const Eigen::Matrix3Xd J = jacobian(q);
  const Eigen::MatrixXd H = hessian(q, weights);
  for (int i = 0; i < q.size(); ++i) {
    Eigen::VectorXd ahead = q, behind = q;
    ahead[i] += kStep;
    behind[i] -= kStep;
    const Eigen::Vector3d column = (value(ahead) - value(behind)) / (2.0 * kStep);
    EXPECT_LT((J.col(i) - column).cwiseAbs().maxCoeff(), kJacobianToleranceM) << "column " << i;
    const Eigen::VectorXd row =
        (jacobian(ahead) - jacobian(behind)).transpose() * weights / (2.0 * kStep);
    EXPECT_LT((H.col(i) - row).cwiseAbs().maxCoeff(), kHessianToleranceM) << "column " << i;
  }
  EXPECT_EQ(H, H.transpose());
}

class Derivatives : public ::testing::Test {
 protected:
  void check_body(const KinematicTree& tree, int body, const Eigen::VectorXd& q) {
    const Eigen::Vector3d p_body = random_vector(), weights = random_vector();
    auto w = tree.make_workspace();
    const int n = tree.num_coordinates();
    const auto at = [&](const Eigen::VectorXd& x) -> const KinematicTree::Workspace& {
      tree.update(x, w);
      return w;
    };
    expect_derivatives_match(
        [&](const Eigen::VectorXd& x) { return tree.position(at(x), body, p_body); },
        [&](const Eigen::VectorXd& x) {
          Eigen::Matrix3Xd J(3, n);
          tree.position_jacobian(at(x), body, p_body, J);
          return J;
        },
        [&](const Eigen::VectorXd& x, const Eigen::Vector3d& v) {
          Eigen::MatrixXd H(n, n);
          tree.position_hessian(at(x), body, p_body, v, H);
          return H;
        },
        q, weights);
    expect_derivatives_match(
        [&](const Eigen::VectorXd& x) { return tree.direction(at(x), body, p_body); },
        [&](const Eigen::VectorXd& x) {
          Eigen::Matrix3Xd J(3, n);
          tree.direction_jacobian(at(x), body, p_body, J);
          return J;
        },
        [&](const Eigen::VectorXd& x, const Eigen::Vector3d& v) {
          Eigen::MatrixXd H(n, n);
          tree.direction_hessian(at(x), body, p_body, v, H);
          return H;
        },
        q, weights);
  }

  void check_com(const KinematicTree& tree, const Eigen::VectorXd& q) {
    auto w = tree.make_workspace();
    const int n = tree.num_coordinates();
    const auto at = [&](const Eigen::VectorXd& x) -> const KinematicTree::Workspace& {
      tree.update(x, w);
      return w;
    };
    expect_derivatives_match([&](const Eigen::VectorXd& x) { return tree.com(at(x)); },
                             [&](const Eigen::VectorXd& x) {
                               Eigen::Matrix3Xd J(3, n);
                               tree.com_jacobian(at(x), J);
                               return J;
                             },
                             [&](const Eigen::VectorXd& x, const Eigen::Vector3d& v) {
                               Eigen::MatrixXd H(n, n);
                               tree.com_hessian(at(x), v, H);
                               return H;
                             },
                             q, random_vector());
  }

  Eigen::Vector3d random_vector() {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    return {unit(generator_), unit(generator_), unit(generator_)};
  }

  std::mt19937 generator_{kSeed};
};

TEST_F(Derivatives, OfEveryBodyOfAnAwkwardTreeMatchFiniteDifferences) {
  const KinematicTree tree = awkward_tree();
  for (int posture = 0; posture < kPostures; ++posture) {
    Eigen::VectorXd q(tree.num_coordinates());
    for (double& value : q) value = random_vector().x();
    for (int body = 0; body < static_cast<int>(tree.bodies().size()); ++body) {
      SCOPED_TRACE("body " + std::to_string(body));
      check_body(tree, body, q);
    }
    check_com(tree, q);
  }
}

TEST_F(Derivatives, OfTheMachinesContactPointsAndCentreOfMassMatchFiniteDifferences) {
  const auto machine = load_machine();
  ASSERT_TRUE(machine) << machine.error().message;
  for (int posture = 0; posture < kPostures; ++posture) {
    const Eigen::VectorXd q = test::random_posture(*machine, generator_);
    for (const WheeledLeg& leg : machine->legs) check_body(machine->tree, leg.carrier_body, q);
    check_body(machine->tree, machine->arm->contact_body, q);
    check_com(machine->tree, q);
  }
}

TEST(KinematicTree, CentreOfMassIsTheMassWeightedMeanOfTheBodies) {
  const KinematicTree tree = awkward_tree();
  auto w = tree.make_workspace();
  tree.update(Eigen::VectorXd::LinSpaced(tree.num_coordinates(), -0.5, 0.7), w);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double mass_kg = 0.0;
  for (int b = 0; b < static_cast<int>(tree.bodies().size()); ++b) {
    sum += tree.bodies()[b].mass_kg * tree.position(w, b, tree.bodies()[b].p_body_com);
    mass_kg += tree.bodies()[b].mass_kg;
  }
  EXPECT_NEAR(tree.total_mass_kg(), mass_kg, 1e-12);
  EXPECT_LT((tree.com(w) - sum / mass_kg).norm(), 1e-12);
}

TEST(KinematicTree, RefusesAChildBeforeItsParent) {
  std::vector<KinematicTree::Body> bodies(3);
  bodies[1].parent = 2;
  bodies[2].parent = 0;
  EXPECT_THROW(KinematicTree(bodies, kNumBaseCoordinates), std::logic_error);
}

TEST(KinematicTree, RefusesACoordinateThatDoesNotExist) {
  std::vector<KinematicTree::Body> bodies(2);
  bodies[1].parent = 0;
  bodies[1].coordinate = kNumBaseCoordinates;
  EXPECT_THROW(KinematicTree(bodies, kNumBaseCoordinates), std::logic_error);
}

}  // namespace
}  // namespace wex
