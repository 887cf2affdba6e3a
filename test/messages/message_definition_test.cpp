// Definitions as texts, and plans by which messages are read.
#include "messages/definition/message_definition.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PolygonStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <rosgraph_msgs/Log.h>
#include <sampled_data_observers/EventStatus.h>
#include <sampled_data_observers/StateEstimate.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Float64MultiArray.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "messages/definition/installed_definitions.h"
#include "messages/definition/md5.h"
#include "messages/definition/plan_compiler.h"
#include "messages/source_reading.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::expect_parts;
using test::fault_of;

using Definition = std::shared_ptr<const MessageDefinition>;

Definition defined(const std::string& type, const std::string& text) {
  return std::make_shared<const MessageDefinition>(type, text);
}

template <class M>
Definition defined() {
  return defined(ros::message_traits::DataType<M>::value(),
                 ros::message_traits::Definition<M>::value());
}

template <class M>
std::vector<std::uint8_t> bytes_of(const M& message) {
  const ros::SerializedMessage sent = ros::serialization::serializeMessage(message);
  return {sent.message_start, sent.buf.get() + sent.num_bytes};
}

/// One field of a message; nothing where it does not hold it.
std::optional<double> field_of(const Definition& definition, const std::string& text,
                               const std::vector<std::uint8_t>& bytes) {
  const std::optional<MessageField> field = find_field(*definition, text);
  if (!field) {
    ADD_FAILURE() << text;
    return std::nullopt;
  }
  PlanCompiler compiler(definition);
  const std::size_t slot = compiler.want_number(field->path);
  const DecodingPlan plan = compiler.compile();
  DecodedMessage message(plan.counts());
  const Malformation fault = plan.run(bytes.data(), bytes.size(), message.slots());
  EXPECT_FALSE(fault.any()) << text << ": " << fault.describe();
  return message.holds(slot) ? std::optional<double>(message.number(slot)) : std::nullopt;
}

std::string definition_fault(const std::string& text) {
  try {
    MessageDefinition("its/Type", text);
  } catch (const DefinitionError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(Md5Test, IsThatOfTheStandard) {
  EXPECT_EQ("d41d8cd98f00b204e9800998ecf8427e", md5_of(""));
  EXPECT_EQ("f96b697d7cb7938d525a2f31aaf161d0", md5_of("message digest"));
  EXPECT_EQ("57edf4a22be3c955ac49da2e2107b67a",
            md5_of("1234567890123456789012345678901234567890123456789012345678901234567890"
                   "1234567890"));
}

template <class M>
void expect_sum() {
  EXPECT_EQ(ros::message_traits::MD5Sum<M>::value(), defined<M>()->md5sum());
}

TEST(MessageDefinitionTest, SumsAreThoseOfROS) {
  expect_sum<diagnostic_msgs::DiagnosticArray>();
  expect_sum<geometry_msgs::PolygonStamped>();
  expect_sum<nav_msgs::Path>();
  expect_sum<rosgraph_msgs::Log>();
  expect_sum<EventStatus>();
  expect_sum<StateEstimate>();
  expect_sum<sensor_msgs::Imu>();
  expect_sum<sensor_msgs::JointState>();
  expect_sum<sensor_msgs::NavSatFix>();
  expect_sum<sensor_msgs::PointCloud2>();
  expect_sum<std_msgs::Float64MultiArray>();
  expect_sum<std_msgs::Header>();
  expect_sum<tf2_msgs::TFMessage>();
}

/// A sum that genmsg made, for what the above have not: texts as constants, times, a CR at an end.
TEST(MessageDefinitionTest, ATextAsConstantTakesAllThatFollows) {
  const MessageDefinition own("its/Type",
                              "string A=  it's # no comment \nint8 B = -3 # one\r\n"
                              "duration[2] d\n\n# nothing\nbool[] c #=\n");
  EXPECT_EQ(md5_of("string A=it's # no comment\nint8 B=-3\nduration[2] d\nbool[] c"), own.md5sum());
  EXPECT_EQ(2u, own.members("its/Type").size());
}

TEST(MessageDefinitionTest, WhatIsNoneIsRefused) {
  expect_parts(definition_fault("float64\n"), {"its/Type", "can't be read: 'float64'"});
  expect_parts(definition_fault("float64[x] a\n"), {"can't be read"});
  expect_parts(definition_fault("float64[ a\n"), {"can't be read"});
  expect_parts(definition_fault("float64[3]=4 a\n"), {"can't be read"});
  expect_parts(definition_fault("Other a\n"), {"its/Type does not say what its/Other is"});
  expect_parts(definition_fault("Type a\n"), {"does not say"});  // within itself
  expect_parts(definition_fault("float64[999999999] a\n"), {"too large"});
  EXPECT_EQ("no fault", definition_fault(""));
}

TEST(DecodingPlanTest, NumbersOfAllKinds) {
  const Definition numbers = defined(
      "its/Type",
      "bool a\nint8 b\nuint8 c\nbyte d\nchar e\nint16 f\nuint16 g\nint32 h\nuint32 i\nint64 j\n"
      "uint64 k\nfloat32 l\nfloat64 m\ntime t\nint16[2] n\nuint8[] o\n");
  std::vector<std::uint8_t> bytes;
  const auto add = [&](auto value) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(value));
  };
  add(std::uint8_t{1});
  add(std::int8_t{-2});
  add(std::uint8_t{200});
  add(std::int8_t{-4});
  add(std::uint8_t{201});
  add(std::int16_t{-30000});
  add(std::uint16_t{60000});
  add(std::int32_t{-2000000000});
  add(std::uint32_t{4000000000});
  add(std::int64_t{-9000000000});
  add(std::uint64_t{10000000000000000000u});
  add(0.1f);
  add(-0.1);
  add(std::uint64_t{5});
  add(std::int16_t{7});
  add(std::int16_t{-8});
  add(std::uint32_t{2});
  add(std::uint8_t{9});
  add(std::uint8_t{10});
  const std::vector<std::pair<const char*, double>> expected = {
      {"a", 1.0},   {"b", -2.0},     {"c", 200.0},  {"d", -4.0},
      {"e", 201.0}, {"f", -30000.0}, {"g", 60000.}, {"h", -2e9},
      {"i", 4e9},   {"j", -9e9},     {"k", 1e19},   {"l", static_cast<double>(0.1f)},
      {"m", -0.1},  {"n.0", 7.0},    {"n.1", -8.0}, {"o.0", 9.0},
      {"o.1", 10.0}};
  for (const auto& [name, value] : expected)
    EXPECT_EQ(value, field_of(numbers, name, bytes)) << name;
  EXPECT_EQ(std::nullopt, field_of(numbers, "o.2", bytes));
  EXPECT_FALSE(find_field(*numbers, "n.2"));
  EXPECT_FALSE(find_field(*numbers, "t"));
  EXPECT_FALSE(find_field(*numbers, "a.0"));
  EXPECT_FALSE(find_field(*numbers, "n"));
}

TEST(DecodingPlanTest, StepsOverWhatVaries) {
  diagnostic_msgs::DiagnosticArray message;
  message.header.frame_id = "somewhere";
  message.status.resize(3);
  message.status[0].name = "first";
  message.status[0].values.resize(2);
  message.status[0].values[1].value = "long enough";
  message.status[1].level = 2;
  message.status[2].level = 1;
  message.status[2].message = "late";
  const Definition definition = defined<diagnostic_msgs::DiagnosticArray>();
  const std::vector<std::uint8_t> bytes = bytes_of(message);
  EXPECT_EQ(2.0, field_of(definition, "status.1.level", bytes));
  EXPECT_EQ(1.0, field_of(definition, "status.2.level", bytes));
  EXPECT_EQ(std::nullopt, field_of(definition, "status.3.level", bytes));

  nav_msgs::Path path;
  path.poses.resize(2);
  path.poses[0].header.frame_id = "map";
  path.poses[1].pose.position.y = 3.5;
  EXPECT_EQ(3.5, field_of(defined<nav_msgs::Path>(), "poses.1.pose.position.y", bytes_of(path)));

  geometry_msgs::PolygonStamped polygon;
  polygon.polygon.points.resize(2);
  polygon.polygon.points[1].z = 1.5f;
  EXPECT_EQ(1.5, field_of(defined<geometry_msgs::PolygonStamped>(), "polygon.points.1.z",
                          bytes_of(polygon)));
}

TEST(DecodingPlanTest, EntriesAreFoundByNamesBesideThemWhereverTheseStand) {
  const char* const kEntry = "\n=====\nMSG: its/Entry\nfloat64 x\nfloat64 y\n";
  const Definition before =
      defined("its/Type", std::string("string[] name\nEntry[] pose\nfloat64[] m") + kEntry);
  const Definition after =
      defined("its/Type", std::string("Entry[] pose\nfloat64[] m\nstring[] names") + kEntry);
  std::vector<std::uint8_t> names = {2, 0, 0, 0, 1, 0, 0, 0, 'a', 3, 0, 0, 0, 'b', '.', 'x'};
  std::vector<std::uint8_t> values = {2, 0, 0, 0};
  for (const double value : {1.0, 2.0, 3.0, 4.0}) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    values.insert(values.end(), begin, begin + sizeof(value));
  }
  values.insert(values.end(), {0, 0, 0, 0});
  std::vector<std::uint8_t> names_first = names;
  names_first.insert(names_first.end(), values.begin(), values.end());
  std::vector<std::uint8_t> names_last = values;
  names_last.insert(names_last.end(), names.begin(), names.end());
  for (const auto& [definition, bytes] : {std::pair(before, names_first), {after, names_last}}) {
    EXPECT_EQ(2.0, field_of(definition, "pose.a.y", bytes));
    EXPECT_EQ(3.0, field_of(definition, "pose.b.x.x", bytes));
    EXPECT_EQ(std::nullopt, field_of(definition, "pose.c.x", bytes));
    EXPECT_EQ(std::nullopt, field_of(definition, "m.a", bytes));
    EXPECT_FALSE(find_field(*definition, "pose.a.z"));
    EXPECT_FALSE(find_field(*definition, "pose.a"));
  }
  EXPECT_EQ("pose.NAME.x, pose.NAME.y, m.NAME", describe_fields(*before));
}

/// With every byte cut off or changed it ends, and never reads on; a sanitizer sees that.
template <class M>
void expect_safe(const M& message, const std::vector<std::string>& fields) {
  const Definition definition = defined<M>();
  PlanCompiler compiler(definition);
  for (const std::string& field : fields)
    compiler.want_number(find_field(*definition, field)->path);
  const DecodingPlan plan = compiler.compile();
  DecodedMessage decoded(plan.counts());
  const std::vector<std::uint8_t> good = bytes_of(message);
  EXPECT_FALSE(plan.run(good.data(), good.size(), decoded.slots()).any());
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::vector<std::uint8_t> cut(good.begin(),
                                        good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_TRUE(plan.run(cut.data(), cut.size(), decoded.slots()).any()) << size;
  }
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> changed = good;
    for (int j = 0; j < 3; ++j)
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    plan.run(changed.data(), changed.size(), decoded.slots()).describe();
  }
}

TEST(DecodingPlanTest, WhateverTheBytesAreItEndsWithThem) {
  sensor_msgs::JointState joints;
  joints.name = {"a", "b"};
  joints.position = {1.0, 2.0};
  expect_safe(joints, {"position.b", "velocity.a"});
  nav_msgs::Path path;
  path.poses.resize(2);
  path.poses[1].header.frame_id = "map";
  expect_safe(path, {"poses.1.pose.position.y"});
  tf2_msgs::TFMessage transforms;
  transforms.transforms.resize(2);
  expect_safe(transforms, {"transforms.0.transform.rotation.w"});
}

TEST(DecodingPlanTest, AListThatClaimsTooMuchTakesNoTime) {
  // Entries without bytes, and entries of which each takes some.
  const Definition empty =
      defined("its/Type",
              "Nothing[] n\nText[] t\n=====\nMSG: its/Nothing\n=====\nMSG: its/Text\n"
              "string[0] none\nstring s\n");
  const DecodingPlan plan = PlanCompiler(empty).compile();
  const std::vector<std::uint8_t> many(4, 0xff);
  std::vector<std::uint8_t> bytes = many;
  bytes.insert(bytes.end(), 4, 0);
  EXPECT_FALSE(plan.run(bytes.data(), bytes.size(), {}).any());
  bytes = many;
  bytes.insert(bytes.end(), many.begin(), many.end());
  const Malformation fault = plan.run(bytes.data(), bytes.size(), {});
  EXPECT_EQ("its field t claims 4294967295 entries, and only 0 bytes follow", fault.describe());
}

TEST(DecodingPlanTest, TypesThatNestEndlesslyInEachOtherAreCompiledOnce) {
  // Ten of the next type in each, fifteen deep: 10^15 members.
  std::string text;
  for (int level = 0; level < 15; ++level) {
    for (int i = 0; i < 10; ++i)
      text += "L" + std::to_string(level) + " m" + std::to_string(i) + "\n";
    text += "=====\nMSG: its/L" + std::to_string(level) + "\n";
  }
  text += "string s\n";
  const Definition deep = defined("its/Type", text);
  EXPECT_FALSE(find_header(*deep));
  EXPECT_EQ("none", describe_fields(*deep));
  const std::vector<std::uint8_t> bytes(100, 0);
  EXPECT_EQ(Malformation::Kind::kEndsEarly,
            PlanCompiler(deep).compile().run(bytes.data(), bytes.size(), {}).kind);
}

/// A workspace with messages of a user's own.
class InstalledDefinitionTest : public ::testing::Test {
 protected:
  InstalledDefinitionTest() {
    std::string name = ::testing::TempDir() + "sdo_msgs_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name);
    folder_ = name;
    package_ = folder_ + "/sdo_test_msgs";
    for (const std::string& path : {package_, package_ + "/msg"}) mkdir(path.c_str(), 0755);
    write("/package.xml",
          "<package format=\"2\"><name>sdo_test_msgs</name><version>0.0.1</version>"
          "<description>x</description><maintainer email=\"a@b.c\">a</maintainer>"
          "<license>none</license></package>");
    const char* const known = getenv("ROS_PACKAGE_PATH");
    setenv("ROS_PACKAGE_PATH", (folder_ + (known ? std::string(":") + known : "")).c_str(), 1);
  }

  ~InstalledDefinitionTest() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& path, const std::string& text) const {
    std::ofstream(package_ + path) << text;
  }

  static std::string fault(const std::string& type) {
    TopicSource source = test::source<std_msgs::Float64MultiArray>({"data.0"});
    source.type = type;
    return fault_of([&] { make_message_source(source); });
  }

  std::string folder_;
  std::string package_;
};

TEST_F(InstalledDefinitionTest, AUsersOwnTypesAreReadAsAnyOther) {
  write("/msg/Wheel.msg", "uint8 id\nwheel_speed\n");
  expect_parts(fault("sdo_test_msgs/Wheel"),
               {"'sdo_test_msgs/Wheel'", "can't be read: 'wheel_speed'"});
  write("/msg/Wheel.msg", "uint8 id\nstring side\nStamped[] speeds\n");
  expect_parts(fault("sdo_test_msgs/Wheel"),
               {"within it, sdo_test_msgs/Stamped", "sdo_test_msgs has Wheel"});
  write("/msg/Stamped.msg", "Header header\ngeometry_msgs/Pose2D pose\n");
  write("/msg/Empty.msg", "");
  expect_parts(fault("sdo_test_msgs/Wheels"),
               {"did you mean sdo_test_msgs/Wheel?", "sdo_test_msgs has Empty, Stamped, Wheel"});
  const Definition wheel = installed_definition("sdo_test_msgs/Wheel");
  EXPECT_EQ(
      "id, speeds.INDEX.header.seq, speeds.INDEX.pose.x, speeds.INDEX.pose.y, "
      "speeds.INDEX.pose.theta",
      describe_fields(*wheel));
  EXPECT_TRUE(installed_definition("sdo_test_msgs/Empty")->members("sdo_test_msgs/Empty").empty());
  const Definition stamped = installed_definition("sdo_test_msgs/Stamped");
  EXPECT_EQ(md5_of(defined<std_msgs::Header>()->md5sum() + " header\n" +
                   installed_definition("geometry_msgs/Pose2D")->md5sum() + " pose"),
            stamped->md5sum());

  TopicSource source = test::source<std_msgs::Float64MultiArray>({"pose.y"});
  source.type = "sdo_test_msgs/Stamped";
  source.stamped_on_receipt = false;
  const auto messages = make_message_source(source);
  std::vector<std::uint8_t> bytes = {1, 0, 0, 0, 12, 0, 0, 0, 34, 0, 0, 0, 0, 0, 0, 0};
  for (const double value : {1.0, 2.0, 3.0}) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(value));
  }
  Event event;
  const MessagePointer sent =
      messages->deserialize(bytes.data(), static_cast<std::uint32_t>(bytes.size()), nullptr);
  EXPECT_EQ(Reading::kEvent, messages->read(sent, test::kReceipt, event));
  EXPECT_EQ(2.0, event.values[0]);
  EXPECT_EQ(12'000'000'034, event.stamp);
}

TEST_F(InstalledDefinitionTest, APackageWithoutItsFilesIsTold) {
  expect_parts(fault("sdo_test_msgs/Wheel"),
               {"sdo_test_msgs has no .msg files (in Debian they are in ros-sdo-test-msgs)"});
}

TEST(InstalledDefinitionsTest, HeadersWithinGiveTheStamp) {
  const Definition path =
      defined("its/Type",
              "float64 value\nPart part\n=====\nMSG: its/Part\nuint8 x\nHeader h\n=====\n"
              "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n");
  const std::optional<MessagePath> header = find_header(*path);
  ASSERT_TRUE(header);
  EXPECT_EQ("std_msgs/Header", type_at(*path, *header));
  EXPECT_EQ(2u, header->size());
}

}  // namespace
}  // namespace sampled_data_observers
