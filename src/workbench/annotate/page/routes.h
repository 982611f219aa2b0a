#pragma once

#include <string>

#include "workbench/annotate/page/http.h"
#include "workbench/annotate/page/windows.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {

/// The value of that name, or nothing.
std::string value_of(const std::map<std::string, std::string>& values, const std::string& name);

/// A request and the objects that answer it.
struct Call {
  Session& session;
  Events& events;
  Windows& windows;
  const Request& request;
  std::string name = {};  ///< the part of the path that matches the * of the route
};

/// Answers a request that may be answered. Throws Error, NotFound if nothing is at the path.
Response answer(Call call);

}  // namespace pcednet::annotate
