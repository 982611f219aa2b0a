#include "workbench/annotate/page/windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "workbench/annotate/page/json.h"
#include "workbench/annotate/scene/not_found.h"

namespace pcednet::annotate {
namespace {

constexpr std::size_t kMostKept = 1000;

}  // namespace

void Events::add(const Event& event) {
  std::string text = "event: " + event_name(event) + "\ndata: " + event_json(event) + "\n\n";
  const std::lock_guard lock(mutex_);
  recent_.push_back(std::move(text));
  ++end_;
  if (recent_.size() > kMostKept) recent_.pop_front();
  if (on_news_) on_news_();
}

void Events::notify(std::function<void()> on_news) {
  const std::lock_guard lock(mutex_);
  on_news_ = std::move(on_news);
}

std::uint64_t Events::end() const {
  const std::lock_guard lock(mutex_);
  return end_;
}

std::string Events::take(std::uint64_t& next) const {
  const std::lock_guard lock(mutex_);
  std::string text;
  next = std::max(next, end_ - recent_.size());
  for (; next < end_; ++next) text += recent_[recent_.size() - (end_ - next)];
  return text;
}

Windows::Windows()
    : start_(fmt::format("{:x}", std::chrono::system_clock::now().time_since_epoch().count())) {}

std::string Windows::name_of(int number) const {
  return number > 0 ? fmt::format("w{}-{}", number, start_) : "";
}

Windows::Opened Windows::open() {
  const std::lock_guard lock(mutex_);
  open_.insert(++count_);
  if (writer_ == 0) writer_ = count_;
  return {name_of(count_), writer_ == count_};
}

void Windows::take_over(const std::string& window) {
  const std::lock_guard lock(mutex_);
  writer_ = number_of(window);
}

std::optional<std::string> Windows::leave(const std::string& window) {
  const std::lock_guard lock(mutex_);
  return close(number_of(window));
}

void Windows::begin_listening(const std::string& window) {
  const std::lock_guard lock(mutex_);
  const int number = number_in_run(window);
  if (number == 0) return;
  ++streams_[number];
  open_.insert(number);
  if (writer_ == 0) writer_ = number;
}

void Windows::end_listening(const std::string& window) {
  const std::lock_guard lock(mutex_);
  if (const int number = number_in_run(window); number > 0) --streams_[number];
}

std::optional<std::string> Windows::close_silent(const std::string& window) {
  const std::lock_guard lock(mutex_);
  const int number = number_in_run(window);
  if (!open_.contains(number) || streams_[number] > 0) return {};
  return close(number);
}

bool Windows::is_writer(const std::string& window) const {
  const std::lock_guard lock(mutex_);
  return writer_ > 0 && window == name_of(writer_);
}

bool Windows::is_open(const std::string& window) const {
  const std::lock_guard lock(mutex_);
  return open_.contains(number_in_run(window));
}

bool Windows::was_any_opened() const {
  const std::lock_guard lock(mutex_);
  return count_ > 0;
}

std::optional<std::string> Windows::close(int number) {
  open_.erase(number);
  if (number != writer_) return {};
  writer_ = open_.empty() ? 0 : *open_.rbegin();
  for (const int other : open_) {
    if (streams_[other] > 0) writer_ = other;
  }
  return name_of(writer_);
}

int Windows::number_in_run(const std::string& window) const {
  int number = count_;
  while (number > 0 && name_of(number) != window) --number;
  return number;
}

int Windows::number_of(const std::string& window) const {
  const int number = number_in_run(window);
  if (!open_.contains(number)) throw NotFound("there is no such window");
  return number;
}

}  // namespace pcednet::annotate
