#include "workbench/annotate/events.h"

#include <algorithm>

#include "workbench/annotate/json.h"

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

}  // namespace pcednet::annotate
