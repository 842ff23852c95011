template <typename Value>
Curve curve(std::string name, const Color& color, const std::vector<DriveSample>& samples,
            const Value& value) {
  Curve c{std::move(name), color, {}, false};
  for (const Sample& s : samples) c.points.emplace_back(s.t_s, value(s));
  return c;
}

}  // namespace

Result<void> draw_timeline(const RunReport& report, const std::filesystem::path& file) {
  WEX_EXPECTS(report.drive && report.drive->samples.size() > 1);
  const std::vector<DriveSample>& samples = report.drive->samples;

  const Panel tilt{
      "tilt (degrees)",
      {curve("roll", kBlue, samples, [](const auto& s) { return kDegrees * s.base[kBaseRoll]; }),
       curve("pitch", kOrange, samples,
             [](const auto& s) { return kDegrees * s.base[kBasePitch]; })},
      {{20.0, "planning limit, 20"}, {-20.0, ""}},
      -22.0,
      22.0};
  const Panel margin{
      "stability margin (m)",
      {curve("scheduled wheels", kBlue, samples,
             [](const auto& s) { return s.scheduled_margin_m; }),
       curve("loaded wheels", kOrange, samples, [](const auto& s) { return s.loaded_margin_m; })},
      {{0.30, "plan, 0.30"}, {0.25, "refinement, 0.25"}, {0.15, "driven, 0.15"}},
      0.0,
      1.0};
  const Panel tracking{
      "tracking (m)",
      {curve("to the reference", kBlue, samples, [](const auto& s) { return s.reference_error_m; }),
       curve("to the goal (clipped)", kOrange, samples,
             [](const auto& s) {
               return s.goal_distance_m < 0.6 ? s.goal_distance_m
                                              : std::numeric_limits<double>::quiet_NaN();
             })},
      {{0.30, "goal tolerance, 0.30"}},
      0.0,
      0.4};
  Curve solve_times{"CPU time of a solve", kBlue, {}, true};
  for (const SolveSample& s : report.drive->solves) {
    solve_times.points.emplace_back(s.t_s, 1e3 * s.cpu_time_s);
  }
  Curve unusable{"no usable result", kUnusable, {}, true};
  for (const SolveSample& s : report.drive->solves) {
    if (!s.usable) unusable.points.emplace_back(s.t_s, 1e3 * s.cpu_time_s);
  }
  Panel solving{"solve time (ms)", {solve_times}, {{100.0, "period, 100"}}, 0.0, 120.0};
  if (!unusable.points.empty()) solving.curves.push_back(unusable);

  Timeline timeline(samples.back().t_s, kNumWheels, 4,
                    Timeline::Tail{report.drive->duration_s, "stopped, holding"});
  timeline.title(report.options.map.filename().string() + ", seed " +
                 std::to_string(report.options.seed) + ": the drive over time");
  timeline.contacts(contact_schedule(samples), "bar: wheel carries load");
  for (const Panel& panel : {tilt, margin, tracking, solving}) timeline.panel(panel);
  timeline.time_axis("time of the drive (s)");
  return timeline.write(file);
}

Result<void> draw_plan_timeline(const Plan& plan, const MachineModel& machine,
                                const std::string& title, const std::filesystem::path& file) {
  const std::vector<WholeBodyNode>& nodes = plan.nodes;
  WEX_EXPECTS(nodes.size() > 1 && nodes.back().t_s > 0.0);
  const double start_height_m = nodes.front().q[kBaseZ];
  const Panel tilt{
      "tilt (degrees)",
      {curve("roll", kBlue, nodes, [](const auto& n) { return kDegrees * n.q[kBaseRoll]; }),
       curve("pitch", kOrange, nodes, [](const auto& n) { return kDegrees * n.q[kBasePitch]; })},
      {{20.0, "planning limit, 20"}, {-20.0, ""}},
      -22.0,
      22.0};
  const Panel way{"base (m)",
                  {curve("height above the start", kBlue, nodes,
                         [&](const auto& n) { return n.q[kBaseZ] - start_height_m; }),
                   curve("distance to the goal / 10", kOrange, nodes,
                         [&](const auto& n) {
                           return 0.1 * std::hypot(n.q[kBaseX] - plan.task.goal.x_m,
                                                   n.q[kBaseY] - plan.task.goal.y_m);
                         })},
                  {},
                  -0.5,
                  0.5};
  const Panel margin{
      "stability margin (m)",
      {curve("limbs in contact", kBlue, nodes,
             [&](const auto& n) { return support_margin_m(machine, n.q, n.contacts); })},
      {{0.30, "plan, 0.30"}},
      0.0,
      1.0};
  Timeline timeline(nodes.back().t_s, kNumLimbs, 3);
  timeline.title(title);
  timeline.contacts(contact_schedule(nodes), "bar: limb carries");
  for (const Panel& panel : {way, tilt, margin}) timeline.panel(panel);
  timeline.time_axis("time of the plan (s)");
  return timeline.write(file);
}

}  // namespace wex::app
