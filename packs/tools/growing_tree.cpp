#include "packs/tools/growing_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

namespace lackwerk::packs {
namespace {

constexpr double pi = std::numbers::pi;
/// A tube's tip has this part of its base's radius.
constexpr double tip_radius = 0.2;
/// Branches sink under their own weight: of their length, from time 0 to 1.
constexpr double sag = 0.06;
/// One that buds later than this is not worth a segment at time 1.
constexpr double last_birth = 0.9;

/// Numbers in [0, 1) that are the same with every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * (*this)(); }

 private:
  std::mt19937 engine_;
};

/// Two unit vectors at right angles to `axis` and to each other.
std::array<glm::dvec3, 2> across(const glm::dvec3& axis) {
  const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 one = glm::normalize(glm::cross(axis, other));
  return {one, glm::cross(axis, one)};
}

/// How much of its length and radius at time 1 a branch has: faster in its youth.
double grown(const TreeBranch& branch, double time) {
  const double age = std::clamp((time - branch.birth) / (1.0 - branch.birth), 0.0, 1.0);
  return age * (1.2 - 0.2 * age);
}

/// When a branch's tip passes `part` of its length at time 1: the other way round.
double time_at(const TreeBranch& branch, double part) {
  const double age = (1.2 - std::sqrt(1.44 - 0.8 * part)) / 0.4;
  return branch.birth + age * (1.0 - branch.birth);
}

/// What a level's branches are like, by their parent.
struct Habit {
  double share;             ///< of the parent's length, for the lowest; the highest have a third of it
  double low, high;         ///< between which parts of the parent they stand
  double spread, narrowed;  ///< degrees from the parent's direction at its foot, and that much less at its tip
  double lag;               ///< how long after the parent's tip has passed they bud
};
constexpr std::array<Habit, 3> habits = {
    {{0.55, 0.25, 0.97, 68.0, 35.0, 0.05}, {0.5, 0.2, 0.9, 52.0, 15.0, 0.05}, {0.45, 0.2, 0.9, 45.0, 10.0, 0.05}}};

void add_children(std::uint32_t parent, int count, const Habit& habit, Random& random, GrowingTree& tree) {
  constexpr double golden_angle = 2.399963229728653;  // leaves stand so that none shades the next
  const TreeBranch above = tree.branches[parent];
  const double turn = random.between(0.0, 2.0 * pi);
  for (int k = 0; k < count; ++k) {
    TreeBranch b;
    b.parent = parent;
    b.level = above.level + 1;
    const double place = (k + random.between(0.3, 0.7)) / count;
    b.along = habit.low + (habit.high - habit.low) * place;
    b.birth = time_at(above, b.along) + habit.lag;
    b.gone = above.gone;
    if (b.birth > last_birth) continue;
    b.length = above.length * habit.share * (1.0 - 0.67 * place) * random.between(0.85, 1.15);
    b.radius = 0.6 * above.radius * (1.0 - (1.0 - tip_radius) * b.along);
    const glm::dvec3 axis = glm::normalize(above.direction + 2.0 * b.along * above.bend);
    const auto [one, two] = across(axis);
    const double angle = (habit.spread - habit.narrowed * place + random.between(-6.0, 6.0)) * pi / 180.0;
    const double azimuth = turn + golden_angle * k + random.between(-0.2, 0.2);
    b.direction = std::cos(angle) * axis + std::sin(angle) * (std::cos(azimuth) * one + std::sin(azimuth) * two);
    // Towards the light, and a little to any side.
    b.bend = glm::dvec3(random.between(-0.08, 0.08), random.between(-0.08, 0.08), random.between(0.1, 0.25));
    tree.branches.push_back(b);
  }
}

/// A branch as it stands at some time.
struct Tube {
  glm::dvec3 base{0.0}, direction{0.0}, bend{0.0};
  double length = 0.0;  ///< at time 1
  double part = 0.0;    ///< of it that has grown
  double radius = 0.0;  ///< at the base now

  /// The axis at `along` of the length at time 1: what has grown stays, the tip goes on.
  [[nodiscard]] glm::dvec3 axis(double along) const {
    return base + length * (along * direction + along * along * bend);
  }
  /// At `s` of what has grown.
  [[nodiscard]] glm::dvec3 surface(double s, double turn) const {
    const double along = s * part;
    const auto [one, two] = across(glm::normalize(direction + 2.0 * along * bend));
    return axis(along) + radius * (1.0 - (1.0 - tip_radius) * s) * (std::cos(turn) * one + std::sin(turn) * two);
  }
  [[nodiscard]] double area() const { return length * part * radius; }  ///< but for a factor
};

std::vector<Tube> tubes_at(const GrowingTree& tree, double time) {
  std::vector<Tube> out;
  out.reserve(tree.branches.size());
  for (const TreeBranch& b : tree.branches) {
    Tube tube;
    if (stands(b, time)) {
      tube.part = grown(b, time);
      if (b.parent != TreeBranch::none) tube.base = out[b.parent].axis(b.along);
      tube.direction = b.direction;
      tube.bend = b.bend;
      if (b.level > 0) tube.bend.z -= sag * time;
      tube.length = b.length;
      tube.radius = tube.part * b.radius;
    }
    out.push_back(tube);
  }
  return out;
}

}  // namespace

GrowingTree growing_tree(const GrowingTreeOptions& options) {
  Random random(options.seed);
  GrowingTree tree;
  TreeBranch trunk;
  trunk.birth = -2.4;
  trunk.length = options.height;
  trunk.radius = options.thickness * options.height;
  trunk.bend = glm::dvec3(random.between(-0.05, 0.05), random.between(-0.05, 0.05), 0.0);
  tree.branches.push_back(trunk);
  const int levels = std::clamp(options.levels, 1, 4);
  std::size_t begin = 0;
  for (int level = 1; level < levels; ++level) {
    const std::size_t end = tree.branches.size();
    // 14 boughs bear 7 branches each, and these 4 twigs.
    const int count = std::max(2, level == 1 ? options.boughs : level == 2 ? options.boughs / 2 : options.boughs / 3);
    for (std::size_t parent = begin; parent < end; ++parent)
      add_children(static_cast<std::uint32_t>(parent), count, habits[static_cast<std::size_t>(level - 1)], random,
                   tree);
    begin = end;
    constexpr std::size_t second_bough = 2;
    if (level == 1 && options.crops && tree.branches.size() > second_bough) tree.branches[second_bough].gone = 0.6;
  }
  return tree;
}

bool stands(const TreeBranch& branch, double time) { return time > branch.birth && time < branch.gone; }

core::PointCloud tree_at(const GrowingTree& tree, double time, std::size_t points, unsigned scan) {
  const std::vector<Tube> tubes = tubes_at(tree, time);
  double total = 0.0;
  for (const Tube& tube : tubes) total += tube.area();
  core::PointCloud cloud;
  cloud.points.reserve(points);
  cloud.labels.reserve(points);
  Random random(0x9e3779b9u * (scan + 1u));
  double before = 0.0;
  for (std::size_t k = 0; k < tubes.size(); ++k) {
    const Tube& tube = tubes[k];
    before += tube.area();
    const double offset_s = random();
    const double offset_turn = random();
    // Rounding the running sum, not each share: the counts add up.
    const bool last = k + 1 == tubes.size();
    const auto until = last ? points : static_cast<std::size_t>(static_cast<double>(points) * before / total);
    for (std::size_t i = 0; cloud.points.size() < until; ++i) {
      // Roberts' two-dimensional sequence: even at any count. By area, of a radius that falls along the axis.
      const auto n = static_cast<double>(i);
      const double area = std::fmod(offset_s + 0.7548776662466927 * n, 1.0);
      const double turn = 2.0 * pi * std::fmod(offset_turn + 0.5698402909980532 * n, 1.0);
      constexpr double fall = 1.0 - tip_radius;
      const double s = (1.0 - std::sqrt(1.0 - area * fall * (2.0 - fall))) / fall;
      cloud.points.push_back(tube.surface(s, turn));
      cloud.labels.push_back(static_cast<std::int32_t>(k));
    }
  }
  return cloud;
}

}  // namespace lackwerk::packs
