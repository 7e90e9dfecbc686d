// Tests of NumPy arrays: files of numpy.save are read, others are rejected with the right reason.
#include "formats/npy.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace mien::formats {
namespace {

std::string little_endian(std::size_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) {
    text += static_cast<char>(value >> (8 * i) & 0xFF);
  }
  return text;
}

template <class Number>
std::string raw(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

std::string file(const std::string& header, const std::string& data, char major = 1) {
  return "\x93NUMPY" + std::string{major, '\0'} + little_endian(header.size(), major == 1 ? 2 : 4) +
         header + data;
}

std::string dictionary(const std::string& descr, const std::string& order,
                       const std::string& shape) {
  return "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }  \n";
}

std::string floats(const std::string& shape, std::size_t count, const std::string& descr = "<f4") {
  return file(dictionary(descr, "False", shape), raw(std::vector<float>(count)));
}

NpyStatus read(const std::string& bytes, NpyArray* array) {
  return read_npy(std::as_bytes(std::span(bytes)), array);
}

NpyStatus status_of(const std::string& bytes) {
  NpyArray array;
  const NpyStatus status = read(bytes, &array);
  const bool empty = array.rank == 0 && array.data.empty();
  EXPECT_TRUE(status == NpyStatus::kOk || empty) << "a rejected file leaves data";
  return status;
}

TEST(Npy, ReadsEveryVersion) {
  const std::vector<float> values = {1.5f, -2.0f, 0.0f, 3e38f, 1e-40f, -0.25f};
  for (const char version : {'\1', '\2', '\3'}) {
    const std::string bytes = file(dictionary("<f4", "False", "(2, 3)"), raw(values), version);
    NpyArray array;
    ASSERT_EQ(read(bytes, &array), NpyStatus::kOk);
    EXPECT_EQ(std::vector(array.shape().begin(), array.shape().end()),
              (std::vector<std::uint64_t>{2, 3}));
    ASSERT_EQ(array.elems(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_EQ(array.value(i), values[i]);
    }
  }
}

TEST(Npy, RoundsDoubles) {
  const std::vector<double> values = {0.1, -1e-300, 2.0};
  const std::string bytes = file(dictionary("<f8", "False", "(3,)"), raw(values));
  NpyArray array;
  ASSERT_EQ(read(bytes, &array), NpyStatus::kOk);
  ASSERT_EQ(array.elems(), 3u);
  EXPECT_EQ(array.value(0), 0.1f);
  EXPECT_EQ(array.value(1), 0.0f);
  EXPECT_EQ(array.value(2), 2.0f);
}

TEST(Npy, ReadsScalarsAndEmptyArrays) {
  EXPECT_EQ(status_of(floats("()", 1)), NpyStatus::kOk);
  EXPECT_EQ(status_of(floats("(0,)", 0)), NpyStatus::kOk);
  EXPECT_EQ(status_of(floats("(4, 0, 2)", 0)), NpyStatus::kOk);
  EXPECT_EQ(status_of(floats("(18446744073709551615, 0)", 0)), NpyStatus::kOk);
  EXPECT_EQ(status_of(floats("(1, 1, 1, 1, 1, 1, 1, 1)", 1)), NpyStatus::kOk);
}

TEST(Npy, ParsesTheHeaderLikePython) {
  const std::string data = raw(std::vector<float>(2));
  for (const char* header :
       {"{'shape': (2,), 'fortran_order': False, 'descr': '<f4'}",
        "{\"descr\":\"<f4\",\"fortran_order\":False,\"shape\":(2,),}",
        "  { 'descr' : '<f4' , 'fortran_order' : False , 'shape' : ( 1 , 2 , ) , } \n\n"}) {
    EXPECT_EQ(status_of(file(header, data)), NpyStatus::kOk) << header;
  }
}

TEST(Npy, RejectsOtherFiles) {
  EXPECT_EQ(status_of(""), NpyStatus::kBadSignature);
  EXPECT_EQ(status_of("PK\3\4 an archive of arrays"), NpyStatus::kBadSignature);
  EXPECT_EQ(status_of(file(dictionary("<f4", "False", "()"), raw(std::vector<float>(1)), 4)),
            NpyStatus::kUnsupportedVersion);
  for (const char* descr : {">f4", "<f2", "<i8", "|u1", "<c8", "|O", "f4", ""}) {
    EXPECT_EQ(status_of(floats("(2,)", 2, descr)), NpyStatus::kUnsupportedType) << descr;
  }
  EXPECT_EQ(status_of(file(dictionary("<f4", "True", "(2, 2)"), raw(std::vector<float>(4)))),
            NpyStatus::kFortranOrder);
}

TEST(Npy, RejectsMalformedHeaders) {
  for (const char* header :
       {"", "{", "{}", "[]", "{'descr': '<f4', 'fortran_order': False}",
        "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': ()}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (), 'more': 1}",
        "{'descr': '<f4', 'fortran_order': 0, 'shape': ()}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': 1}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1.0,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1",
        "{'descr': '<f4', 'fortran_order': False, 'shape': ()} x",
        "{'descr': '<f4' 'fortran_order': False, 'shape': ()}",
        "{'descr: '<f4', 'fortran_order': False, 'shape': ()}"}) {
    EXPECT_EQ(status_of(file(header, raw(std::vector<float>(1)))), NpyStatus::kBadHeader) << header;
  }
}

TEST(Npy, RejectsShapesThatAreTooLarge) {
  EXPECT_EQ(status_of(floats("(1, 1, 1, 1, 1, 1, 1, 1, 1)", 1)), NpyStatus::kBadShape);
  EXPECT_EQ(status_of(floats("(4294967297,)", 1)), NpyStatus::kBadShape);
  EXPECT_EQ(status_of(floats("(4294967296, 4294967296)", 1)), NpyStatus::kBadShape);
  EXPECT_EQ(status_of(floats("(18446744073709551615, 2)", 1)), NpyStatus::kBadShape);
}

TEST(Npy, RejectsFilesOfAnotherSize) {
  const std::string whole = floats("(2, 3)", 6);
  for (std::size_t size = 8; size < whole.size(); ++size) {
    EXPECT_EQ(status_of(whole.substr(0, size)), NpyStatus::kTruncated) << size;
  }
  EXPECT_EQ(status_of(whole + "x"), NpyStatus::kTrailingBytes);
  EXPECT_EQ(status_of(file(std::string(10, ' '), "").substr(0, 12)), NpyStatus::kTruncated);
}

TEST(Npy, ReadsWhatItWrites) {
  constexpr std::uint64_t kLarge = std::numeric_limits<std::uint64_t>::max();
  for (const std::vector<std::uint64_t>& shape : std::vector<std::vector<std::uint64_t>>{
           {}, {7}, {2, 3}, {1, 3, 65, 65}, {kLarge, 0}, {1, 1, 1, 1, 1, 1, 1, 2}}) {
    const NpyHeader header = npy_header(shape);
    std::size_t elems = 1;
    for (const std::uint64_t dim : shape) {
      elems *= dim;
    }
    const std::string bytes =
        std::string(header.bytes, sizeof header.bytes) + raw(std::vector<float>(elems));
    NpyArray array;
    ASSERT_EQ(read(bytes, &array), NpyStatus::kOk);
    EXPECT_EQ(std::vector(array.shape().begin(), array.shape().end()), shape);
    EXPECT_EQ(header.bytes[sizeof header.bytes - 1], '\n');
  }
  // The maximum number of digits.
  const std::vector<std::uint64_t> most(kMaxNpyRank, kLarge);
  const NpyHeader header = npy_header(most);
  EXPECT_NE(std::string(header.bytes, sizeof header.bytes).find(", )}"), std::string::npos);
}

TEST(Npy, EveryStatusHasItsOwnMessage) {
  std::set<std::string> messages;
  for (std::uint8_t i = 0; i < kNpyStatusCount; ++i) {
    messages.insert(message(static_cast<NpyStatus>(i)));
  }
  EXPECT_EQ(messages.size(), kNpyStatusCount);
  EXPECT_EQ(messages.count("unknown status"), 0u);
}

}  // namespace
}  // namespace mien::formats
