# Tests of parts: of functions, and of simulated teams. ./test builds and runs them with
# the address and undefined-behaviour sanitizers.
ergocast_test(NAME modes_tests LABELS unit OPTIMISED
  SOURCES
    modes/eigen_modes_test.cc
    modes/free_grid_test.cc
    modes/free_modes_test.cc
    modes/provide_test.cc
    modes/table_test.cc
  LIBS ergocast::modes)
ergocast_test(NAME core_tests LABELS unit OPTIMISED
  SOURCES
    core/amendments_test.cc
    core/basis_in_space_test.cc
    core/basis_test.cc
    core/block_layout_test.cc
    core/block_sums_test.cc
    core/charge_test.cc
    core/command_terms_test.cc
    core/control_in_space_test.cc
    core/control_test.cc
    core/coverage_table_test.cc
    core/detour_test.cc
    core/forecast_order_test.cc
    core/forecast_test.cc
    core/geometry_test.cc
    core/half_life_test.cc
    core/hold_test.cc
    core/indexed_rings_test.cc
    core/kinds_test.cc
    core/look_ahead_test.cc
    core/measure_test.cc
    core/merge_property_test.cc
    core/mower_test.cc
    core/search/contacts_test.cc
    core/search/drift_test.cc
    core/search/objects_test.cc
    core/search/search_notes_test.cc
    core/noise_test.cc
    core/perturbation_test.cc
    core/potential_test.cc
    core/search/search_test.cc
    core/separation_test.cc
    core/sites/site_history.cc
    core/sites/site_rows_test.cc
    core/smooth_input_test.cc
    core/speed_limit_test.cc
    core/step_constraints_test.cc
    core/target_shift_test.cc
    core/zones_test.cc
    core/vehicle_teams_test.cc
    core/vehicle_test.cc
    core/wall_following_test.cc
    core/walls_attack_test.cc
    core/station_test.cc
    core/end_schedule_test.cc
    core/walls_test.cc
  LIBS ergocast_lab ergocast::target ergocast::team)

ergocast_test(NAME target_tests LABELS unit OPTIMISED
  SOURCES
    target/contour/contour_test.cc
    target/cosine_integrals_test.cc
    target/fractional_domains_test.cc
    target/map_file_test.cc
    target/occupancy_map_test.cc
    target/polygon_target_test.cc
    target/raster_integral_test.cc
    target/target_in_space_test.cc
    target/target_test.cc
    target/trapezoids_test.cc
  LIBS ergocast::target PNG::PNG)

ergocast_test(NAME team_tests LABELS unit
  SOURCES
    team/beacon_book_test.cc
    team/command_window_test.cc
    plan/hostile_plan_test.cc
    plan/mission_fields_test.cc
    plan/mission_limits_test.cc
    team/liveness_test.cc
    team/median_metric_test.cc
    team/mission_follower_test.cc
    team/participant_test.cc
    plan/plan_test.cc
    team/radio_range_test.cc
    team/state_assembler_test.cc
    text/input_file_test.cc
    text/printable_test.cc
    text/versions_test.cc
  LIBS ergocast::team ergocast::text)

ergocast_test(NAME lcmtypes_tests LABELS unit OWN_FLAGS
  SOURCES
    lcmtypes/channels_test.cc
    lcmtypes/codec_test.cc
    lcmtypes/fixed16_test.cc
    lcmtypes/forged_coverage_test.cc
    lcmtypes/hostile_bytes_test.cc
    lcmtypes/message_authenticator_test.cc
    lcmtypes/subscriptions_test.cc
  LIBS ergocast::codec ${XXHASH_LIBRARY} ${SODIUM_LIBRARY})
# lcm-gen's types read our bytes as well; they need the codec's include folders.
target_include_directories(lcmtypes_tests SYSTEM PRIVATE
  $<TARGET_PROPERTY:ergocast_codec,BINARY_DIR>/generated ${LCM_INCLUDE_DIR} ${XXHASH_INCLUDE_DIR}
  ${SODIUM_INCLUDE_DIR})
target_compile_options(lcmtypes_tests PRIVATE -fno-strict-aliasing)

ergocast_test(NAME process_logic_tests LABELS unit
  SOURCES
    agent/beacons_test.cc
    agent/bodies_test.cc
    agent/control_test.cc
    agent/digest_test.cc
    agent/divided_team_test.cc
    agent/end_test.cc
    agent/foresight_test.cc
    agent/forgetting_test.cc
    agent/receiving_test.cc
    agent/incarnation_test.cc
    agent/joining_test.cc
    agent/mission_repeat_test.cc
    agent/pause_test.cc
    agent/radio_test.cc
    agent/reckoning_test.cc
    agent/repair_test.cc
    agent/search_exchange_test.cc
    coordinator/admission_test.cc
    coordinator/after_takeover_test.cc
    coordinator/announcement_test.cc
    coordinator/coordinator_test.cc
    coordinator/departure_test.cc
    coordinator/farewell_test.cc
    coordinator/part_schedule_test.cc
    coordinator/amending_test.cc
    coordinator/pausing_test.cc
    coordinator/recalling_test.cc
    coordinator/takeover_test.cc
    sim/command_history_test.cc
    sim/world_resume_test.cc
    sim/record_window_test.cc
    sim/world_bodies_test.cc
    sim/world_members_test.cc
    sim/world_physics_test.cc
    sim/world_realtime_test.cc
    sim/world_safety_test.cc
    sim/world_test.cc
  LIBS ergocast_agent ergocast_coordinator ergocast_sim ergocast::codec)

ergocast_test(NAME runtime_tests LABELS unit
  SOURCES
    runtime/key_file_test.cc
    runtime/event_log_test.cc
    runtime/gathering_test.cc
    runtime/lcm_datagram_test.cc
    runtime/logging_test.cc
    runtime/loop_lag_test.cc
    runtime/rate_limit_test.cc
    runtime/repeat_guard_test.cc
    runtime/sealed_file_test.cc
  LIBS ergocast::runtime ergocast::event_log lcm::lcm)

ergocast_test(NAME relay_tests LABELS unit
  SOURCES
    relay/endpoint_test.cc
    relay/flow_test.cc
    relay/queue_test.cc
  LIBS ergocast_relay ergocast::runtime ${XXHASH_LIBRARY})
target_include_directories(relay_tests SYSTEM PRIVATE ${XXHASH_INCLUDE_DIR})

ergocast_test(NAME cot_tests LABELS unit
  SOURCES
    cli/cot/events_test.cc
  LIBS ergocast_tak pugixml::pugixml)

ergocast_test(NAME foxglove_tests LABELS unit
  SOURCES
    cli/foxglove/client_test.cc
    cli/foxglove/live_topics_test.cc
    cli/foxglove/websocket_test.cc
  LIBS ergocast_foxglove nlohmann_json::nlohmann_json)

ergocast_test(NAME cli_tests LABELS unit
  SOURCES
    cli/amend_order_test.cc
    cli/amendment_lines_test.cc
    cli/desk_orders_test.cc
    cli/desk_requests_test.cc
    cli/new_law_test.cc
    cli/pause_order_test.cc
    cli/rate_test.cc
    cli/team_monitor_test.cc
    cli/workers_test.cc
    ${CMAKE_SOURCE_DIR}/cli/progress_line.cc
    ${CMAKE_SOURCE_DIR}/cli/study/workers.cc
  LIBS ergocast_orders ergocast_run_directory ergocast::core ergocast::runtime)

ergocast_test(NAME page_server_tests LABELS unit
  SOURCES
    cli/connections_test.cc
    cli/page_control_test.cc
    cli/tls_server_test.cc
    support/tls.cc
  LIBS ergocast_page_server OpenSSL::SSL)

ergocast_test(NAME deploy_tests LABELS unit
  SOURCES
    cli/deploy/files_test.cc
    cli/deploy/hosts_file_test.cc
  LIBS ergocast_deploy)

ergocast_test(NAME status_tests LABELS unit
  SOURCES
    cli/amendment_history_test.cc
    cli/client_list_test.cc
    cli/live_team_test.cc
    cli/recorded_team_test.cc
    cli/run_registry_test.cc
    cli/team_history_test.cc
    cli/team_text_test.cc
    cli/team_trouble_test.cc
    cli/team_view_test.cc
  LIBS ergocast_registry ergocast_team_page nlohmann_json::nlohmann_json)

ergocast_test(NAME logger_tests LABELS unit
  SOURCES
    logger/amendments_test.cc
    logger/changed_target_test.cc
    logger/drivers_test.cc
    logger/farewell_test.cc
    logger/full_disk_test.cc
    logger/line_file_test.cc
    logger/recorder_test.cc
    report/report_test.cc
    logger/resume_gaps_test.cc
    logger/resume_test.cc
    logger/segments_test.cc
    report/statistics_test.cc
    logger/summary_test.cc
  LIBS ergocast::report ergocast::scenario)

# plan/plan.proto is for other programs; ours do not need its code.
ergocast_messages(ergocast_plan_message plan/plan.proto)

ergocast_test(NAME geo_tests LABELS unit
  SOURCES target/geo/svg_test.cc
  LIBS ergocast::geo)

ergocast_test(NAME scenario_tests LABELS unit
  SOURCES
    scenario/assign_test.cc
    scenario/cases_test.cc
    scenario/free_domain_test.cc
    scenario/geodata_test.cc
    scenario/geojson_target_test.cc
    scenario/map_target_test.cc
    scenario/map_walls_test.cc
    scenario/new_target_test.cc
    scenario/other_peoples_data_test.cc
    scenario/plan_proto_test.cc
    scenario/scenario_to_plan_test.cc
    scenario/polygon_flaw_test.cc
    scenario/problems_test.cc
    scenario/scenario_test.cc
    scenario/space_test.cc
    scenario/svg_target_test.cc
    scenario/warnings_test.cc
    scenario/water_column_test.cc
  LIBS ergocast_lab ergocast::scenario ergocast_scenario_messages ergocast_plan_message ergocast_logger PNG::PNG)

ergocast_test(NAME studies_tests LABELS unit
  SOURCES
    studies/confidence_test.cc
    studies/encoding_test.cc
    studies/linearised_test.cc
    studies/rare_modes_test.cc
    studies/study_run_test.cc
    studies/study_table_test.cc
    studies/table_test.cc
  LIBS ergocast_studies ergocast_theorems ergocast_scenario_messages PNG::PNG)

ergocast_test(NAME example_tests LABELS unit
  SOURCES examples/driver_test.cc
  LIBS ergocast_example_driver)

ergocast_test(NAME mavlink_tests LABELS unit
  SOURCES
    bridges/mavlink/codec_test.cc
    bridges/mavlink/driver_test.cc
    bridges/mavlink/fence_test.cc
    bridges/mavlink/fixes_test.cc
    bridges/mavlink/link_test.cc
    bridges/mavlink/places_test.cc
    bridges/mavlink/take_command_test.cc
    bridges/mavlink/vehicle_test.cc
  LIBS ergocast_mavlink ergocast::geo)
if(TARGET ergocast_ros2)
  ergocast_test(NAME ros2_tests LABELS unit
    SOURCES
      bridges/ros2/bridge_file_test.cc
      bridges/ros2/display_test.cc
      bridges/ros2/map_test.cc
      bridges/ros2/positions_test.cc
      bridges/ros2/robot_test.cc
      bridges/ros2/steering_test.cc
    LIBS ergocast_ros2 ergocast::target)
endif()

ergocast_test(NAME doctor_tests LABELS unit
  SOURCES
    cli/doctor/bus_listener_test.cc
    cli/doctor/fragment_rule_test.cc
    cli/doctor/kernel_limits_test.cc
    cli/doctor/peer_findings_test.cc
    cli/doctor/peer_ledger_test.cc
    cli/doctor/ports_test.cc
    cli/doctor/print_test.cc
    cli/doctor/probe_test.cc
    cli/doctor/host_conditions_test.cc
    cli/doctor/routing_test.cc
    cli/doctor/socket_table_test.cc
  LIBS ergocast_doctor nlohmann_json::nlohmann_json)

ergocast_test(NAME layering_tests LABELS unit
  SOURCES layering/includes_test.cc layering/modules_test.cc layering/sources_test.cc
  LIBS ergocast::core)

# Where the bits of results must be those of every processor.
set(same_bits)
set(same_bits_targets)
foreach(library core target geo team plan agent coordinator sim logger)
  list(APPEND same_bits "\"$<TARGET_FILE:ergocast_${library}>\"")
  list(APPEND same_bits_targets ergocast_${library})
endforeach()
ergocast_test(NAME portable_tests LABELS unit OPTIMISED
  SOURCES core/portable_math_test.cc layering/same_bits_test.cc target/bits_of_targets_test.cc
  LIBS ergocast::target)
add_dependencies(portable_tests ${same_bits_targets})
target_compile_definitions(portable_tests PRIVATE
  ERGOCAST_NM="${CMAKE_NM}" ERGOCAST_OBJDUMP="${CMAKE_OBJDUMP}" "ERGOCAST_SAME_BITS=$<JOIN:${same_bits},$<COMMA>>")

ergocast_test(NAME lab_tests LABELS lab OPTIMISED
  SOURCES
    lab/invariants_home_test.cc
    lab/invariants_known_test.cc
    lab/invariants_test.cc
    lab/laboratory_test.cc
    lab/message_loss_test.cc
    lab/pause_test.cc
    lab/planned_targets_test.cc
    lab/planned_ends_test.cc
    lab/planned_laws_test.cc
    lab/recall_test.cc
    lab/site_exchange_test.cc
    lab/site_simulation_test.cc
    lab/sites_test.cc
  LIBS ergocast_lab ergocast::scenario
  PROPERTIES COST 30)
