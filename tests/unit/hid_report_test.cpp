// Values in reports: any offset, width and sign, there and back.
#include "input/hid_report.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hid_samples.hpp"

namespace lackwerk::input {
namespace {

using samples::Bytes;

HidField field_at(std::uint32_t offset, std::uint32_t size, std::uint32_t count, bool is_signed) {
  HidField field;
  field.bit_offset = offset;
  field.bit_size = size;
  field.count = count;
  field.logical_min = is_signed ? -1 : 0;
  field.logical_max = 1;
  return field;
}

TEST(HidReport, EveryOffsetAndWidthGoesThereAndBack) {
  std::mt19937 random(3);
  for (std::uint32_t offset = 0; offset < 20; ++offset)
    for (std::uint32_t size = 1; size <= 32; ++size)
      for (const bool is_signed : {false, true}) {
        const auto field = field_at(offset, size, 2, is_signed);
        Bytes payload((offset + 2 * size + 7) / 8);
        for (auto& byte : payload) byte = static_cast<std::uint8_t>(random());
        const auto before = read_hid_value(field, payload, 0);
        const std::int64_t span = std::int64_t{1} << size;
        const std::int64_t value = static_cast<std::int64_t>(random()) % span - (is_signed ? span / 2 : 0);
        ASSERT_TRUE(write_hid_value(field, payload, 1, value));
        EXPECT_EQ(read_hid_value(field, payload, 1), value) << offset << " " << size;
        EXPECT_EQ(read_hid_value(field, payload, 0), before) << "the neighbour stays";
      }
}

TEST(HidReport, SignsAreExtendedPerField) {
  const Bytes payload{0xff, 0x0f};
  EXPECT_EQ(read_hid_value(field_at(0, 12, 1, true), payload), -1);
  EXPECT_EQ(read_hid_value(field_at(0, 12, 1, false), payload), 4095);
  EXPECT_EQ(read_hid_value(field_at(0, 16, 1, true), payload), 4095);
}

TEST(HidReport, NothingBeyondTheEnd) {
  Bytes payload{1, 2};
  EXPECT_EQ(read_hid_value(field_at(9, 8, 1, false), payload), std::nullopt);
  EXPECT_EQ(read_hid_value(field_at(0, 8, 2, false), payload, 2), std::nullopt);
  EXPECT_EQ(read_hid_value(field_at(0, 33, 1, false), payload), std::nullopt);
  EXPECT_EQ(read_hid_value(field_at(0, 0, 1, false), payload), std::nullopt);
  EXPECT_FALSE(write_hid_value(field_at(9, 8, 1, false), payload, 0, 1));
  EXPECT_EQ(payload, (Bytes{1, 2}));
}

TEST(HidReport, ShortAndUnknownReportsAreRefused) {
  const auto parsed = parse_hid_descriptor(samples::surface_dial(), "test");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(hid_report_bytes(*parsed, HidReportKind::input, 1), 8u);
  EXPECT_FALSE(split_input_report(*parsed, Bytes{}));
  EXPECT_FALSE(split_input_report(*parsed, Bytes{1}));
  EXPECT_FALSE(split_input_report(*parsed, Bytes{1, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(split_input_report(*parsed, Bytes(64, 99)));  // no report 99
  const Bytes whole{1, 0, 5, 0, 0, 0, 0, 0, 0x3a};
  const auto report = split_input_report(*parsed, whole);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->id, 1);
  EXPECT_EQ(report->payload.size(), 8u);
  EXPECT_TRUE(split_input_report(*parsed, Bytes{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));  // longer ones are padded
}

}  // namespace
}  // namespace lackwerk::input
