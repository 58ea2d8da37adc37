// SPDX-License-Identifier: Apache-2.0
// ROS 2's nav_msgs/Path in MCAP (https://mcap.dev/spec), one message in CDR, little-endian. A file
// without chunks and without an index, which its specification leaves out at will.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "altiplan/error.hpp"
#include "host/import_export/format_functions.hpp"

namespace altiplan::host {
namespace {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::string_view kPathType = "nav_msgs/msg/Path";
/// What a record holds, by its first byte.
enum class Record : unsigned char {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  end_of_data = 15
};

constexpr const char* kPathSchema =
    "std_msgs/Header header\n"
    "geometry_msgs/PoseStamped[] poses\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\n"
    "string frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\n"
    "int32 sec\n"
    "uint32 nanosec\n"
    "================================================================================\n"
    "MSG: geometry_msgs/PoseStamped\n"
    "std_msgs/Header header\n"
    "geometry_msgs/Pose pose\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Pose\n"
    "geometry_msgs/Point position\n"
    "geometry_msgs/Quaternion orientation\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Point\n"
    "float64 x\n"
    "float64 y\n"
    "float64 z\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Quaternion\n"
    "float64 x\n"
    "float64 y\n"
    "float64 z\n"
    "float64 w\n";

/// Numbers and strings as MCAP and CDR write them; CDR aligns each to its size.
class Bytes {
 public:
  template <class Number>
  void add(Number value) {
    for (std::size_t n = 0; n < sizeof value; ++n) {
      out_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * n) & 0xff);
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  /// Its length, then its characters.
  void add(std::string_view text) {
    add(std::uint32_t(text.size()));
    out_ += text;
  }
  template <class Number>
  void add_aligned(Number value) {
    out_.append((sizeof value - out_.size() % sizeof value) % sizeof value, '\0');
    add(value);
  }
  void add_record(Record kind, const Bytes& content) {
    out_ += static_cast<char>(kind);
    add(std::uint64_t(content.out_.size()));
    out_ += content.out_;
  }
  void append(std::string_view bytes) { out_ += bytes; }
  const std::string& text() const { return out_; }

 private:
  std::string out_;
};

/// Seconds since 1970 in CDR, and the frame of ROS's maps.
void add_header(Bytes& out, double seconds) {
  const double whole = std::floor(seconds);
  out.add_aligned(std::int32_t(whole));
  out.add_aligned(std::uint32_t(std::min(999'999'999.0, std::round((seconds - whole) * 1e9))));
  out.add_aligned(std::uint32_t(4));
  out.append(std::string_view("map\0", 4));
}

/// The orientation is level, toward the next point.
std::string path_message(const MissionText& text) {
  const double start = text.start_time_s.value_or(0);
  const Polyline& route = text.local;
  Bytes out;
  add_header(out, start);
  out.add_aligned(std::uint32_t(route.size()));
  double heading = 0;
  for (std::size_t n = 0; n < route.size(); ++n) {
    add_header(out, start + text.times_s.at(n));
    if (n + 1 < route.size() && (route[n + 1] - route[n]).head<2>().norm() > 0) {
      heading = std::atan2(route[n + 1].y() - route[n].y(), route[n + 1].x() - route[n].x());
    }
    for (const double value : route[n]) {
      out.add_aligned(std::bit_cast<std::uint64_t>(rounded(value, text.decimals.metres)));
    }
    for (const double value : {0.0, 0.0, std::sin(heading / 2), std::cos(heading / 2)}) {
      out.add_aligned(std::bit_cast<std::uint64_t>(value));
    }
  }
  constexpr std::string_view kLittleEndian("\0\1\0\0", 4);
  return std::string(kLittleEndian) + out.text();
}

/// Reads numbers from bytes, aligned from where it began.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  Number next() {
    Number value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  template <class Number>
  Number aligned() {
    take((sizeof(Number) - at_ % sizeof(Number)) % sizeof(Number));
    return next<Number>();
  }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size() - at_) {
      throw Error("the file is damaged: it ends too early");
    }
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::string_view text() { return take(next<std::uint32_t>()); }
  std::string_view rest() const { return bytes_.substr(at_); }
  bool is_done() const { return at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

void skip_header(Cursor& cdr) {
  cdr.aligned<std::int32_t>();
  cdr.aligned<std::uint32_t>();
  cdr.take(cdr.aligned<std::uint32_t>());
}

Polyline path_of(std::string_view message) {
  Cursor encapsulation(message);
  if (encapsulation.take(4).substr(0, 2) != std::string_view("\0\1", 2)) {
    throw Error("expected a message in little-endian CDR");
  }
  Cursor cdr(message.substr(4));
  skip_header(cdr);
  const auto count = cdr.aligned<std::uint32_t>();
  Polyline route;
  for (std::uint32_t n = 0; n < count; ++n) {
    skip_header(cdr);
    Vec3 point;
    for (double& value : point) {
      value = cdr.aligned<double>();
    }
    for (int part = 0; part < 4; ++part) {
      cdr.aligned<double>();
    }
    if (!point.allFinite()) {
      throw Error("pose " + std::to_string(n + 1) + ": expected finite numbers");
    }
    route.push_back(point);
  }
  return route;
}

/// The message of the first channel of paths.
Polyline first_path(std::string_view text) {
  Cursor file(text);
  file.take(kMcapMagic.size());
  std::optional<std::uint16_t> schema;
  std::optional<std::uint16_t> channel;
  while (!file.is_done()) {
    const auto kind = Record(file.next<std::uint8_t>());
    Cursor record(file.take(file.next<std::uint64_t>()));
    if (kind == Record::schema && !schema) {
      const auto id = record.next<std::uint16_t>();
      if (record.text() == kPathType) {
        schema = id;
      }
    } else if (kind == Record::channel && schema && !channel) {
      const auto id = record.next<std::uint16_t>();
      if (record.next<std::uint16_t>() == *schema) {
        channel = id;
      }
    } else if (kind == Record::message && channel && record.next<std::uint16_t>() == *channel) {
      constexpr std::size_t kSequenceAndTimes = 20;
      record.take(kSequenceAndTimes);
      Polyline route = path_of(record.rest());
      if (route.empty()) {
        throw Error("it contains no route");
      }
      return route;
    } else if (kind == Record::chunk) {
      throw Error("files with chunks are not read: write it without them");
    } else if (kind == Record::end_of_data) {
      break;
    }
  }
  throw Error("it holds no " + std::string(kPathType));
}
}  // namespace

bool is_mcap(std::string_view text) { return text.starts_with(kMcapMagic); }

std::string mcap_text(const MissionText& text) {
  const auto start = std::uint64_t(std::round(text.start_time_s.value_or(0) * 1e9));
  constexpr std::uint16_t kId = 1;
  Bytes header;
  header.add(std::string_view("ros2"));
  header.add(std::string_view("altiplan"));
  Bytes schema;
  schema.add(kId);
  schema.add(kPathType);
  schema.add(std::string_view("ros2msg"));
  schema.add(std::string_view(kPathSchema));
  Bytes channel;
  channel.add(kId);
  channel.add(kId);
  channel.add(std::string_view("/plan"));
  channel.add(std::string_view("cdr"));
  channel.add(std::uint32_t(0));  // no metadata
  Bytes message;
  message.add(kId);
  message.add(std::uint32_t(0));
  message.add(start);
  message.add(start);
  message.append(path_message(text));
  Bytes end_of_data;
  end_of_data.add(std::uint32_t(0));  // no checksum
  Bytes footer;
  footer.add(std::uint64_t(0));  // no summary
  footer.add(std::uint64_t(0));
  footer.add(std::uint32_t(0));
  Bytes file;
  file.append(kMcapMagic);
  file.add_record(Record::header, header);
  file.add_record(Record::schema, schema);
  file.add_record(Record::channel, channel);
  file.add_record(Record::message, message);
  file.add_record(Record::end_of_data, end_of_data);
  file.add_record(Record::footer, footer);
  file.append(kMcapMagic);
  return file.text();
}

LocalRoute read_mcap(const std::string& file, const std::string& text) {
  try {
    return {first_path(text)};
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
}
}  // namespace altiplan::host
