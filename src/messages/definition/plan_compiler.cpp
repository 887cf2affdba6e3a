#include "messages/definition/plan_compiler.h"

#include <algorithm>
#include <set>

namespace sampled_data_observers {
namespace {

using Entry = PathStep::Entry;

bool is_message_type(const std::string& type) { return type.find('/') != std::string::npos; }

}  // namespace

PlanCompiler::PlanCompiler(std::shared_ptr<const MessageDefinition> definition)
    : definition_(std::move(definition)) {
  plan_.definition_ = definition_;
}

std::size_t PlanCompiler::want(const Want& wanted) {
  for (const Want& known : wants_) {
    const bool is_same = known.path == wanted.path && known.half == wanted.half;
    if (is_same) return known.slot;
  }
  wants_.push_back(wanted);
  DecodingPlan::Counts& counts = plan_.counts_;
  wants_.back().slot = wanted.is_text ? counts.texts++ : counts.numbers++;
  return wants_.back().slot;
}

std::size_t PlanCompiler::want_number(const MessagePath& path) {
  return want({path, 0, false, Half::kNone});
}

std::size_t PlanCompiler::want_text(const MessagePath& path) {
  return want({path, 0, true, Half::kNone});
}

std::pair<std::size_t, std::size_t> PlanCompiler::want_time(const MessagePath& path) {
  const std::size_t seconds = want({path, 0, false, Half::kSeconds});
  return {seconds, want({path, 0, false, Half::kNanoseconds})};
}

DecodingPlan PlanCompiler::compile(bool is_whole) {
  Views views;
  for (const Want& wanted : wants_) views.push_back({&wanted, 0});
  plan_.first_ = compile_program(definition_->type(), views);
  plan_.is_whole_ = is_whole;
  if (!is_whole) {
    Steps& steps = plan_.programs_[plan_.first_];
    while (!steps.empty() && !is_of_use(steps.back())) steps.pop_back();
  }
  return std::move(plan_);
}

bool PlanCompiler::is_of_use(const Step& step) {
  const bool reads = step.reads.begin < step.reads.end || step.parts.begin < step.parts.end;
  return reads || step.slot != DecodingPlan::kNoSlot || step.kind == Step::Kind::kNames;
}

std::size_t PlanCompiler::compile_program(const std::string& type, const Views& views) {
  Steps steps;
  if (type == "string") {
    steps.emplace_back();
    steps.back().kind = Step::Kind::kText;
    steps.back().member = &definition_->type();
  } else {
    add_type(type, views, steps);
  }
  plan_.programs_.push_back(std::move(steps));
  return plan_.programs_.size() - 1;
}

/// One for each type, however often it stands in others.
std::size_t PlanCompiler::passing_program(const std::string& type) {
  const auto known = passing_.find(type);
  if (known != passing_.end()) return known->second;
  const std::size_t program = compile_program(type, {});
  passing_.emplace(type, program);
  return program;
}

/// The names by which entries of one message's lists are wanted, and slots for their places.
DecodingPlan::Range PlanCompiler::register_names(const Views& views) {
  std::set<std::string> names;
  for (const View& view : views) {
    if (view.step().entry == Entry::kName) names.insert(view.step().name);
  }
  DecodingPlan::Range range{plan_.names_.size(), plan_.names_.size() + names.size()};
  for (const std::string& name : names) plan_.names_.push_back({name, plan_.counts_.entries++});
  return range;
}

void PlanCompiler::add_type(const std::string& type, const Views& views, Steps& steps) {
  const std::vector<MessageMember>& members = definition_->members(type);
  const DecodingPlan::Range names = register_names(views);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const MessageMember& member = members[i];
    Views inner;
    for (const View& view : views) {
      if (view.step().member == i) inner.push_back(view);
    }
    const std::optional<std::size_t> size = definition_->fixed_size(member.type);
    if (member.is_list()) {
      const bool names_entries = names.begin < names.end && names_of(members) == i;
      if (names_entries) {
        add_names(member, names, steps);
      } else {
        add_list(member, inner, names, steps);
      }
    } else if (size || member.length == std::size_t{0}) {
      add_piece(member, size.value_or(0) * member.length.value_or(1), inner, steps);
    } else if (member.type == "string" && !member.is_several) {
      add_text(member, inner, steps);
    } else if (member.is_several || inner.empty()) {
      add_each(member, inner, steps);
    } else {
      for (View& view : inner) view = view.inner();
      add_type(member.type, inner, steps);
    }
  }
}

/// Pieces that follow each other are one.
void PlanCompiler::add_piece(const MessageMember& member, std::size_t size, const Views& views,
                             Steps& steps) {
  if (steps.empty() || steps.back().kind != Step::Kind::kPiece) {
    steps.emplace_back();
    steps.back().reads = {plan_.reads_.size(), plan_.reads_.size()};
    steps.back().member = &member.name;
  }
  Step& piece = steps.back();
  const std::size_t entry_size = definition_->fixed_size(member.type).value_or(0);
  for (const View& view : views) {
    const Place place = place_of(member.type, view.inner());
    const std::size_t offset = piece.size + view.step().index * entry_size + place.offset;
    plan_.reads_.push_back({0, offset, place.type, view.want->slot});
  }
  piece.reads.end = plan_.reads_.size();
  piece.size += size;
}

void PlanCompiler::add_text(const MessageMember& member, const Views& views, Steps& steps) {
  steps.emplace_back();
  steps.back().kind = Step::Kind::kText;
  steps.back().member = &member.name;
  if (!views.empty()) steps.back().slot = views.front().want->slot;
}

void PlanCompiler::add_list(const MessageMember& member, const Views& views,
                            DecodingPlan::Range names, Steps& steps) {
  if (const std::optional<std::size_t> size = definition_->fixed_size(member.type)) {
    add_entries(member, *size, views, names, steps);
  } else {
    add_each(member, views, steps);
  }
}

void PlanCompiler::add_entries(const MessageMember& member, std::size_t size, const Views& views,
                               DecodingPlan::Range names, Steps& steps) {
  Step list;
  list.kind = Step::Kind::kEntries;
  list.size = size;
  list.member = &member.name;
  list.reads.begin = plan_.reads_.size();
  for (const View& view : views) {
    const Place place = place_of(member.type, view.inner());
    if (view.step().entry == Entry::kIndex) {
      plan_.reads_.push_back({view.step().index, place.offset, place.type, view.want->slot});
      continue;
    }
    if (list.slot == DecodingPlan::kNoSlot) list.slot = plan_.counts_.lists++;
    std::size_t name = names.begin;
    while (plan_.names_[name].text != view.step().name) ++name;
    plan_.named_reads_.push_back(
        {list.slot, plan_.names_[name].entry, size, place.offset, place.type, view.want->slot});
  }
  list.reads.end = plan_.reads_.size();
  steps.push_back(list);
}

/// Also over a single message of which nothing is wanted.
void PlanCompiler::add_each(const MessageMember& member, const Views& views, Steps& steps) {
  Step each;
  each.kind = Step::Kind::kEach;
  each.is_counted = member.is_list();
  each.length = member.length.value_or(1);
  each.member = &member.name;
  std::map<std::size_t, Views> wanted;
  for (const View& view : views) wanted[view.step().index].push_back(view.inner());
  std::vector<DecodingPlan::Part> parts;
  for (const auto& [index, inner] : wanted) {
    parts.push_back({index, compile_program(member.type, inner)});
  }
  each.parts.begin = plan_.parts_.size();
  plan_.parts_.insert(plan_.parts_.end(), parts.begin(), parts.end());
  each.parts.end = plan_.parts_.size();
  each.program = passing_program(member.type);
  steps.push_back(each);
}

void PlanCompiler::add_names(const MessageMember& member, DecodingPlan::Range names, Steps& steps) {
  steps.emplace_back();
  steps.back().kind = Step::Kind::kNames;
  steps.back().names = names;
  steps.back().member = &member.name;
}

PlanCompiler::Place PlanCompiler::place_of(const std::string& type, const View& view) const {
  if (!is_message_type(type)) {
    if (const std::optional<NumberType> number = number_type(type)) return {0, *number};
    return {view.want->half == Half::kNanoseconds ? std::size_t{4} : 0, NumberType::kUint32};
  }
  const std::vector<MessageMember>& members = definition_->members(type);
  const PathStep& step = view.step();
  std::size_t offset = 0;
  for (std::size_t i = 0; i < step.member; ++i) {
    const std::size_t size = definition_->fixed_size(members[i].type).value_or(0);
    offset += size * members[i].length.value_or(1);
  }
  const MessageMember& member = members[step.member];
  Place place = place_of(member.type, view.inner());
  place.offset += offset + step.index * definition_->fixed_size(member.type).value_or(0);
  return place;
}

}  // namespace sampled_data_observers
