// Report descriptors: real ones give the fields they have, broken ones an error with the place.
#include "input/hid_descriptor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "hid_samples.hpp"

namespace lackwerk::input {
namespace {

using samples::Bytes;

HidDescriptor parse(const Bytes& bytes) {
  auto parsed = parse_hid_descriptor(bytes, "test");
  EXPECT_TRUE(parsed) << (parsed ? "" : parsed.error().line());
  return parsed.value_or(HidDescriptor{});
}

std::string field_of_error(const Bytes& bytes) {
  const auto parsed = parse_hid_descriptor(bytes, "test");
  return parsed ? "no error" : parsed.error().field;
}

/// A descriptor of one input field inside an application collection, from what stands before its Input item.
Bytes with_input(Bytes items, std::uint8_t flags = 0x02) {
  Bytes out{0x05, 0x01, 0x09, 0x0e, 0xa1, 0x01};
  out.insert(out.end(), items.begin(), items.end());
  out.insert(out.end(), {0x81, flags, 0xc0});
  return out;
}

const HidField* find(const HidDescriptor& descriptor, HidUsage usage, HidReportKind kind = HidReportKind::input) {
  const auto found = std::find_if(descriptor.fields.begin(), descriptor.fields.end(), [&](const HidField& field) {
    return field.kind == kind && usage_at(field, 0) == usage;
  });
  return found == descriptor.fields.end() ? nullptr : &*found;
}

TEST(HidDescriptor, SurfaceDial) {
  const auto bytes = samples::surface_dial();
  ASSERT_EQ(bytes.size(), 488u);
  const auto parsed = parse(bytes);
  EXPECT_TRUE(parsed.numbered);
  ASSERT_EQ(parsed.applications.size(), 5u);
  EXPECT_EQ(parsed.applications[0], (HidUsage{0x01, 0x0e}));
  EXPECT_EQ(parsed.applications[3], (HidUsage{0x01, 0x80}));

  const auto* button = find(parsed, {0x09, 1});
  ASSERT_NE(button, nullptr);
  EXPECT_EQ(button->report_id, 1);
  EXPECT_EQ(button->bit_offset, 0u);
  EXPECT_EQ(button->bit_size, 1u);

  const auto* dial = find(parsed, {0x01, 0x37});
  ASSERT_NE(dial, nullptr);
  EXPECT_EQ(dial->report_id, 1);
  EXPECT_EQ(dial->bit_offset, 8u);  // button, touch, six bits of padding
  EXPECT_EQ(dial->bit_size, 16u);
  EXPECT_EQ(dial->logical_min, -32767);
  EXPECT_EQ(dial->logical_max, 32767);
  EXPECT_TRUE(dial->relative);
  EXPECT_TRUE(dial->variable);
  EXPECT_EQ(dial->application, (HidUsage{0x01, 0x0e}));

  const auto* multiplier = find(parsed, {0x01, 0x48}, HidReportKind::feature);
  ASSERT_NE(multiplier, nullptr);
  EXPECT_EQ(multiplier->logical_max, 3600);
  EXPECT_EQ(multiplier->bit_size, 16u);
  EXPECT_EQ(multiplier->bit_offset, 0u);

  // 16 bits each of X and Y, 8 of width follow the dial: 8 bytes and the id, as the device sends them.
  EXPECT_EQ(parsed.report_bits.at({HidReportKind::input, 1}), 64u);
  EXPECT_EQ(parsed.report_bits.at({HidReportKind::feature, 1}), 56u);
  const auto* x = find(parsed, {0x01, 0x30});
  ASSERT_NE(x, nullptr);
  EXPECT_TRUE(x->null_state);
  EXPECT_EQ(x->logical_max, 0);
}

TEST(HidDescriptor, SpaceNavigator) {
  const auto bytes = samples::space_navigator();
  ASSERT_EQ(bytes.size(), 228u);
  const auto parsed = parse(bytes);
  ASSERT_EQ(parsed.applications.size(), 1u);
  EXPECT_EQ(parsed.applications[0], (HidUsage{0x01, 0x08}));
  const auto* turn = find(parsed, {0x01, 0x33});
  ASSERT_NE(turn, nullptr);
  EXPECT_EQ(turn->report_id, 2);
  EXPECT_EQ(turn->count, 3u);
  EXPECT_EQ(usage_at(*turn, 2), (HidUsage{0x01, 0x35}));
  EXPECT_EQ(turn->logical_min, -350);
  EXPECT_EQ(turn->logical_max, 350);
  EXPECT_EQ(turn->physical_max, 1400);
  EXPECT_EQ(turn->unit_exponent, -4);
  EXPECT_TRUE(turn->relative);  // what the firmware claims
  const auto* buttons = find(parsed, {0x09, 1});
  ASSERT_NE(buttons, nullptr);
  EXPECT_EQ(buttons->report_id, 3);
  EXPECT_EQ(buttons->count, 2u);
  EXPECT_EQ(parsed.report_bits.at({HidReportKind::input, 3}), 16u);
}

TEST(HidDescriptor, MouseOfTheSpecification) {
  const auto parsed = parse(samples::mouse());
  EXPECT_FALSE(parsed.numbered);
  ASSERT_EQ(parsed.fields.size(), 2u);  // padding is no field
  EXPECT_EQ(parsed.fields[0].count, 3u);
  EXPECT_EQ(usage_at(parsed.fields[0], 2), (HidUsage{0x09, 3}));
  EXPECT_EQ(parsed.fields[1].bit_offset, 8u);
  EXPECT_EQ(parsed.fields[1].logical_min, -127);
  EXPECT_EQ(usage_at(parsed.fields[1], 1), (HidUsage{0x01, 0x31}));
  EXPECT_EQ(usage_at(parsed.fields[1], 9), (HidUsage{0x01, 0x31})) << "the last usage repeats";
  EXPECT_EQ(parsed.report_bits.at({HidReportKind::input, 0}), 24u);
}

TEST(HidDescriptor, RadialControllerHasAnglesAsUnit) {
  const auto parsed = parse(samples::radial_controller());
  const auto* dial = find(parsed, {0x01, 0x37});
  ASSERT_NE(dial, nullptr);
  EXPECT_EQ(dial->bit_offset, 1u);
  EXPECT_EQ(dial->bit_size, 15u);
  EXPECT_EQ(dial->unit, 0x14u);
  EXPECT_EQ(dial->unit_exponent, -1);
  EXPECT_EQ(dial->physical_min, -3600);
}

TEST(HidDescriptor, KeyboardWithWheelIsAnArray) {
  const auto parsed = parse(samples::keyboard_with_wheel());
  ASSERT_EQ(parsed.applications.size(), 2u);
  const auto& keys = parsed.fields.back();
  EXPECT_FALSE(keys.variable);
  EXPECT_EQ(usage_at(keys, 0xe9), (HidUsage{0x0c, 0xe9}));
  EXPECT_EQ(usage_at(keys, 0x400), std::nullopt);
  EXPECT_EQ(keys.application, (HidUsage{0x0c, 0x01}));
}

TEST(HidDescriptor, SignsFollowTheMinimum) {
  // 25 FF: 255 beside a minimum of 0, -1 beside a negative one.
  auto parsed = parse(with_input({0x09, 0x37, 0x15, 0x00, 0x25, 0xff, 0x75, 0x08, 0x95, 0x01}));
  ASSERT_EQ(parsed.fields.size(), 1u);
  EXPECT_EQ(parsed.fields[0].logical_max, 255);
  parsed = parse(with_input({0x09, 0x37, 0x15, 0x81, 0x25, 0xff, 0x75, 0x08, 0x95, 0x01}));
  EXPECT_EQ(parsed.fields[0].logical_min, -127);
  EXPECT_EQ(parsed.fields[0].logical_max, -1);
  // Four bytes, and the maximum before the minimum.
  parsed = parse(with_input({0x09, 0x37, 0x27, 0xff, 0xff, 0xff, 0xff, 0x15, 0x00, 0x75, 0x20, 0x95, 0x01}));
  EXPECT_EQ(parsed.fields[0].logical_max, 4294967295);
}

TEST(HidDescriptor, UsagesTakeThePageInForceAtTheField) {
  const auto parsed = parse(with_input({0x09, 0x37, 0x0b, 0x38, 0x00, 0x01, 0x00, 0x05, 0x0c, 0x09, 0xe0, 0x15, 0x00,
                                        0x25, 0x01, 0x75, 0x01, 0x95, 0x03}));
  ASSERT_EQ(parsed.fields.size(), 1u);
  EXPECT_EQ(usage_at(parsed.fields[0], 0), (HidUsage{0x0c, 0x37})) << "6.2.2.8: the last page declared";
  EXPECT_EQ(usage_at(parsed.fields[0], 1), (HidUsage{0x01, 0x38})) << "extended usages bring theirs";
  EXPECT_EQ(usage_at(parsed.fields[0], 2), (HidUsage{0x0c, 0xe0}));
}

TEST(HidDescriptor, PushAndPop) {
  const auto parsed = parse(
      with_input({0x75, 0x08, 0x95, 0x01, 0x15, 0x81, 0x25, 0x7f, 0xa4, 0x75, 0x10, 0x05, 0x0c, 0xb4, 0x09, 0x37}));
  ASSERT_EQ(parsed.fields.size(), 1u);
  EXPECT_EQ(parsed.fields[0].bit_size, 8u);
  EXPECT_EQ(usage_at(parsed.fields[0], 0), (HidUsage{0x01, 0x37}));
}

TEST(HidDescriptor, SloppyDevicesPass) {
  // Delimiters: the first of the alternatives. Long item, reserved items, and padding after the last collection.
  auto bytes = with_input({0xa9, 0x01, 0x09, 0x37, 0x09, 0x38, 0xa9, 0x00, 0xfe, 0x02, 0x10,
                           0xaa, 0xbb, 0x0c, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x01});
  bytes.insert(bytes.end(), {0x00, 0x00, 0x27});
  const auto parsed = parse(bytes);
  ASSERT_EQ(parsed.fields.size(), 1u);
  EXPECT_EQ(usage_at(parsed.fields[0], 0), (HidUsage{0x01, 0x37}));
  EXPECT_EQ(usage_at(parsed.fields[0], 1), (HidUsage{0x01, 0x37}));

  // A range that is empty, and one whose minimum lies above its maximum: bits counted, no field.
  const auto odd = parse(with_input({0x19, 0x05, 0x29, 0x01, 0x15, 0x05, 0x25, 0x01, 0x75, 0x08, 0x95, 0x02}));
  EXPECT_TRUE(odd.fields.empty());
  EXPECT_EQ(odd.report_bits.at({HidReportKind::input, 0}), 16u);
  // More than 32 bits a value: the same.
  const auto wide = parse(with_input({0x09, 0x37, 0x25, 0x01, 0x75, 0x40, 0x95, 0x01}));
  EXPECT_TRUE(wide.fields.empty());
  EXPECT_EQ(wide.report_bits.at({HidReportKind::input, 0}), 64u);
}

TEST(HidDescriptor, BrokenOnesNameTheByte) {
  EXPECT_EQ(field_of_error({}), "byte 0");
  EXPECT_EQ(field_of_error({0xc0}), "byte 0");                                // closes what was never opened
  EXPECT_EQ(field_of_error({0x05, 0x01, 0xa1, 0x01}), "byte 4");              // never closed
  EXPECT_EQ(field_of_error({0xa1, 0x01, 0x26, 0x00}), "byte 2");              // cut
  EXPECT_EQ(field_of_error({0xa1, 0x01, 0xfe, 0x09, 0x00}), "byte 2");        // long item, cut
  EXPECT_EQ(field_of_error({0xa1, 0x01, 0xb4, 0xc0}), "byte 2");              // pop without push
  EXPECT_EQ(field_of_error({0xa1, 0x01, 0x85, 0x00, 0xc0}), "byte 2");        // report id 0
  EXPECT_EQ(field_of_error({0xa1, 0x01, 0x86, 0x00, 0x01, 0xc0}), "byte 2");  // report id 256
  EXPECT_EQ(field_of_error(Bytes(4097, 0x00)), "byte 0");
  EXPECT_EQ(field_of_error(Bytes(17, 0xa4)), "byte 16");
  EXPECT_EQ(field_of_error(Bytes(33, 0xa0)), "byte 32");
}

TEST(HidDescriptor, CountsAreBounded) {
  // 2^32 - 1 values of 255 bits; 2^31 reports of one bit; both beyond 4096 bytes.
  EXPECT_NE(field_of_error(with_input({0x75, 0xff, 0x97, 0xff, 0xff, 0xff, 0xff})), "no error");
  EXPECT_NE(field_of_error(with_input({0x77, 0xff, 0xff, 0xff, 0xff, 0x97, 0xff, 0xff, 0xff, 0xff})), "no error");
  EXPECT_NE(field_of_error(with_input({0x75, 0x20, 0x96, 0x01, 0x04})), "no error");
  EXPECT_EQ(field_of_error(with_input({0x75, 0x20, 0x96, 0x00, 0x04})), "no error");
  Bytes usages;
  for (int k = 0; k < 1025; ++k) usages.insert(usages.end(), {0x09, 0x37});
  EXPECT_NE(field_of_error(with_input(usages)), "no error");
}

TEST(HidDescriptor, ChangedBytesNeverCrash) {
  std::mt19937 random(7);
  const std::array<Bytes, 4> all{samples::surface_dial(), samples::space_navigator(), samples::keyboard_with_wheel(),
                                 samples::absolute_dial()};
  int refused = 0;
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes = all.at(round % all.size());
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (round % 5 == 0) bytes.resize(random() % bytes.size());
    const auto parsed = parse_hid_descriptor(bytes, "test");
    if (!parsed) {
      ++refused;
      continue;
    }
    for (const auto& field : parsed->fields) {
      EXPECT_GE(field.count, 1u);
      EXPECT_LE(field.bit_size, 32u);
      EXPECT_LE(field.bit_offset + field.bit_size * field.count, max_report_bits);
      EXPECT_LE(field.logical_min, field.logical_max);
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace lackwerk::input
