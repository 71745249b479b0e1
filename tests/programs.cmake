# Tests of the programs, which ./test builds without sanitizers; tests of memory; and long
# computations, which sanitizers would make twelve times as long.
add_dependencies(all_lab ergocast)

# Replaces the program's allocator, so it is a separate program.
ergocast_test(NAME allocation_tests LABELS unit
  SOURCES core/allocation_test.cc
  LIBS ergocast::core ergocast::modes ergocast::team)
target_link_options(allocation_tests PRIVATE
  -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=aligned_alloc,--wrap=posix_memalign)

# The memory that a map takes.
ergocast_test(NAME memory_tests LABELS unit
  SOURCES target/map_memory_test.cc
  LIBS ergocast::target PNG::PNG)

if(TARGET ergocast_example_mujoco)
  ergocast_test(NAME mujoco_tests LABELS unit
    SOURCES examples/mujoco_test.cc
    LIBS ergocast_example_mujoco ergocast_lab ergocast::scenario)
endif()

ergocast_test(NAME drawing_tests LABELS unit
  SOURCES scenario/other_peoples_drawings_test.cc
  LIBS ergocast::scenario)
ergocast_test(NAME long_lab_tests LABELS lab
  SOURCES
    lab/charge_test.cc
    lab/foresight_test.cc
    lab/judgement_test.cc
    lab/large_team_test.cc
    lab/moved_scenario_test.cc
    studies/same_as_simulate_test.cc
    support/drawn_agreement.cc
    support/drawn_files.cc
    support/drawn_scenario.cc
  LIBS ergocast_studies ergocast_lab ergocast::scenario ergocast_scenario_messages PNG::PNG
  PROPERTIES COST 20)
ergocast_test(NAME paper_tests LABELS paper
  SOURCES
    paper/corollary1_test.cc
    paper/cube_corners_test.cc
    paper/fig1a_test.cc
    paper/fig1b_test.cc
    paper/fig2_test.cc
    paper/law_test.cc
    paper/looking_ahead_test.cc
    paper/proposition1_test.cc
    paper/quadrimodal_corners_test.cc
    paper/same_as_simulation_test.cc
    paper/theorem1_test.cc
    paper/theorem2_test.cc
    paper/theorems_in_space_test.cc
    paper/uniform_square_test.cc
  LIBS ergocast_lab ergocast_theorems ergocast::scenario)

# Missions under faults, an entry of the table for each scenario and pace. With
# ERGOCAST_TRIALS=nightly in the environment an entry runs up to 2200 of them.
function(ergocast_trials NAME PROGRAM ENTRY)
  add_test(NAME ${NAME}
    COMMAND ${CMAKE_COMMAND} -DERGOCAST=$<TARGET_FILE:${PROGRAM}> -DSOURCE_DIR=${CMAKE_SOURCE_DIR}
      -DENTRY=${ENTRY} -P ${CMAKE_CURRENT_SOURCE_DIR}/lab/trials.cmake)
  set_tests_properties(${NAME} PROPERTIES LABELS lab TIMEOUT 3600)
endfunction()
set(trials lab/covering_seeds.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${trials})
file(STRINGS ${trials} entries REGEX "^[a-z]")
foreach(entry ${entries})
  string(REGEX REPLACE " .*" "" entry "${entry}")
  ergocast_trials(${entry} ergocast ${entry})
endforeach()

# Libraries that tests preload into the programs that they start.
add_library(hold_at SHARED support/hold_at.cc)
add_library(no_number SHARED support/no_number.cc)
add_library(no_socket_filter SHARED support/no_socket_filter.cc)

# Real programs and real LCM.
ergocast_test(NAME process_tests LABELS process RUNS_PROGRAMS
  SOURCES
    process/commands/bad_input_test.cc
    process/bus_reader_test.cc
    process/by_hand_test.cc
    process/changed_target_test.cc
    process/command_replay_test.cc
    process/datagram_filter_test.cc
    process/commands/deploy_test.cc
    process/commands/new_test.cc
    process/commands/doctor_test.cc
    process/driver_test.cc
    process/commands/export_test.cc
    process/fault_test.cc
    process/flood_test.cc
    process/found_test.cc
    process/freeze_test.cc
    process/full_disk_test.cc
    process/gathering_test.cc
    process/commands/key_test.cc
    process/kinds_test.cc
    process/launch_test.cc
    process/lcm_conformance_test.cc
    process/libraries_test.cc
    process/commands/log_test.cc
    process/lost_files_test.cc
    process/modes_test.cc
    process/page_attack_test.cc
    process/page_control_test.cc
    process/page_tls_test.cc
    process/commands/logs_test.cc
    process/no_metric_test.cc
    process/commands/replay_test.cc
    process/restart_test.cc
    process/run_test.cc
    process/segments_test.cc
    process/separation_test.cc
    process/commands/set_test.cc
    process/commands/status_test.cc
    process/home_test.cc
    process/amend_test.cc
    process/end_test.cc
    process/pause_test.cc
    process/recall_test.cc
    process/commands/stop_test.cc
    process/commands/study_test.cc
    process/team_size_test.cc
    process/commands/trials_test.cc
    process/commands/typing_test.cc
    process/commands/verify_test.cc
    process/commands/versions_test.cc
    process/waiting_test.cc
    process/commands/watch_test.cc
    process/world_safety_test.cc
    process/law_test.cc
    process/mow_test.cc
    process/objects_test.cc
    process/search_test.cc
    process/sighting_test.cc
    process/zone_test.cc
    support/http.cc
    support/tls.cc
  LIBS ergocast_doctor ergocast::event_log OpenSSL::SSL)
if(TARGET ergocast-example-mujoco)
  target_sources(process_tests PRIVATE process/mujoco_test.cc)
  add_dependencies(process_tests ergocast-example-mujoco)
endif()
add_library(no_more_processes SHARED support/no_more_processes.cc)
add_dependencies(process_tests ergocast-example-driver no_more_processes no_number)
target_compile_definitions(process_tests PRIVATE
  ERGOCAST_NO_MORE_PROCESSES="$<TARGET_FILE:no_more_processes>"
  ERGOCAST_NO_NUMBER="$<TARGET_FILE:no_number>")

# The team as events for TAK.
ergocast_test(NAME cot_process_tests LABELS process RUNS_PROGRAMS
  SOURCES process/cot_test.cc
  LIBS pugixml::pugixml)

# The team for Foxglove.
ergocast_test(NAME foxglove_process_tests LABELS process RUNS_PROGRAMS
  SOURCES process/foxglove_test.cc support/http.cc support/tls.cc
  LIBS OpenSSL::SSL
  PROPERTIES FIXTURES_REQUIRED foxglove_client)
target_compile_definitions(foxglove_process_tests PRIVATE
  ERGOCAST_FOXGLOVE_CLIENT="${CMAKE_BINARY_DIR}/foxglove_client")

# The page in Chromium.
ergocast_test(NAME page_tests LABELS page RUNS_PROGRAMS
  SOURCES
    page/amendment_test.cc
    page/drawing_test.cc
    page/found_test.cc
    page/layout_test.cc
    page/map_test.cc
    page/control_test.cc
    page/motion_test.cc
    page/presses_test.cc
    page/report_test.cc
    page/requests_test.cc
    page/served_test.cc
    page/space_test.cc
    page/study_test.cc
    page/words_test.cc
    page/zone_cancel_test.cc
    page/zone_requests_test.cc
    page/zone_test.cc
    support/browser.cc
    support/http.cc
    support/tls.cc
  LIBS ergocast_lab ergocast_logger ergocast::plan ergocast::target OpenSSL::SSL)

# A register of the findings of each check, as the programs report them.
ergocast_test(NAME checks_can_fail_tests LABELS process RUNS_PROGRAMS
  SOURCES
    checks_can_fail/check_test.cc
    checks_can_fail/invariants_test.cc
    checks_can_fail/mistaken_files.cc
    checks_can_fail/no_metric_test.cc
    checks_can_fail/planted_fields.cc
    checks_can_fail/refusals_test.cc
    checks_can_fail/scenario_mistakes.cc
    checks_can_fail/target_mistakes.cc
    checks_can_fail/verify_test.cc
    checks_can_fail/words.cc
    checks_can_fail/zone_files_test.cc
  LIBS ergocast_lab ergocast::scenario ergocast_scenario_messages PNG::PNG
  PROPERTIES COST 40)
# The real `ergocast` with selectable bugs, whose files have the linker's names of the wrapped
# functions.
set(bugs checks_can_fail/amendment_bugs.cc checks_can_fail/coverage_bugs.cc checks_can_fail/motion_bugs.cc checks_can_fail/participant_bugs.cc)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${bugs})
set(wrapped)
foreach(file ${bugs})
  file(STRINGS ${file} lines REGEX "^WRAPPED")
  list(APPEND wrapped ${lines})
endforeach()
list(TRANSFORM wrapped REPLACE [[^[^"]*"([^"]*)".*$]] [[LINKER:--wrap=\1]])
add_executable(ergocast-with-bugs ${bugs} $<TARGET_OBJECTS:ergocast>)
target_link_options(ergocast-with-bugs PRIVATE ${wrapped})
target_link_libraries(ergocast-with-bugs PRIVATE $<TARGET_PROPERTY:ergocast,LINK_LIBRARIES>)
add_dependencies(checks_can_fail_tests ergocast-with-bugs)
# A covering seed finds a bug that few seeds find; without a bug the same missions pass.
ergocast_trials(trials_can_fail ergocast-with-bugs walled_wings_in_real_time)
set_tests_properties(trials_can_fail PROPERTIES LABELS process
  ENVIRONMENT "ERGOCAST_BUG=a restarted world takes bodies to stand"
  PASS_REGULAR_EXPRESSION "bodies keep out of walls: .*seeds [0-9]+: exit code 4")
ergocast_trials(trials_can_pass ergocast-with-bugs walled_wings_in_real_time)
set_tests_properties(trials_can_pass PROPERTIES LABELS process)

# Scripts that need root; exit code 77 means skipped.
function(ergocast_script_test NAME LABEL SCRIPT)
  add_test(NAME ${NAME} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/${SCRIPT} ${ARGN})
  set_tests_properties(${NAME} PROPERTIES LABELS ${LABEL} SKIP_RETURN_CODE 77 TIMEOUT 900)
endfunction()
# With `ctest -C nightly` only. They use the kept bare Debian in turn; a test that waits for its
# turn has not started. The limit only ends what hangs: they compile every installed header alone,
# and machines differ tenfold in speed.
function(ergocast_nightly_script_test NAME LABEL SCRIPT)
  add_test(NAME ${NAME} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/${SCRIPT} ${ARGN} CONFIGURATIONS nightly)
  set_tests_properties(${NAME} PROPERTIES LABELS ${LABEL} SKIP_RETURN_CODE 77 TIMEOUT 3600
    RESOURCE_LOCK debian)
endfunction()
ergocast_script_test(deployed_over_ssh hosts hosts/deploy_ssh_test.sh
  ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${CMAKE_SOURCE_DIR}/scenarios/quadrimodal_corners.textproto)
# Four sites behind routers, with links that delay, lose, repeat and forge; and inside WireGuard.
ergocast_script_test(relay_sites hosts hosts/relay_sites.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
  ${CMAKE_SOURCE_DIR}/scenarios/quadrimodal_corners.textproto --lockstep --agents 8 --dt 0.5
  --duration 100 --delay-ms 5 --jitter-ms 4 --loss-percent 3)
ergocast_script_test(relay_sites_with_drivers hosts hosts/relay_sites.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
  ${CMAKE_SOURCE_DIR}/scenarios/quadrimodal_corners.textproto --drivers --agents 4 --sites 2 --dt 0.1
  --duration 20 --delay-ms 5 --jitter-ms 2 --loss-percent 5 --cut-s 0)
ergocast_script_test(relay_wireguard hosts hosts/relay_wireguard_test.sh
  ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${CMAKE_SOURCE_DIR}/scenarios/quadrimodal_corners.textproto)
ergocast_script_test(tinc hosts hosts/tinc_test.sh
  ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${CMAKE_SOURCE_DIR}/scenarios/quadrimodal_corners.textproto)
# The pages of docs/reference/ are what the code prints now.
add_test(NAME reference_is_current
  COMMAND ${CMAKE_SOURCE_DIR}/docs/reference/make --check ${CMAKE_BINARY_DIR})
set_tests_properties(reference_is_current PROPERTIES LABELS process)
add_dependencies(all_process reference-facts)
add_test(NAME mcap_reference_reader COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/report/export/mcap_test.sh
  $<TARGET_FILE:ergocast> ${CMAKE_BINARY_DIR}/mcap_reader)
add_test(NAME ros2_mcap_reader COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/report/export/ros2_mcap_test.sh
  $<TARGET_FILE:ergocast> ${CMAKE_BINARY_DIR}/mcap_reader ${CMAKE_BINARY_DIR}/node_ros2)
set_tests_properties(mcap_reference_reader ros2_mcap_reader PROPERTIES LABELS process TIMEOUT 300)
add_executable(mavlink-lines bridges/mavlink/lines.cc)
target_link_libraries(mavlink-lines PRIVATE ergocast_mavlink nlohmann_json::nlohmann_json ergocast::warnings)
ergocast_script_test(mavlink_reference process bridges/mavlink/reference_test.sh
  $<TARGET_FILE:mavlink-lines> ${CMAKE_BINARY_DIR}/node_mavlink)
# It fetches node-mavlink, which the tests with mock autopilots need.
set_tests_properties(mavlink_reference PROPERTIES FIXTURES_SETUP node_mavlink)
ergocast_test(NAME mavlink_flight_tests LABELS process RUNS_PROGRAMS
  SOURCES bridges/mavlink/flight_test.cc
  PROPERTIES FIXTURES_REQUIRED node_mavlink)
target_compile_definitions(mavlink_flight_tests PRIVATE ERGOCAST_NODE_MAVLINK="${CMAKE_BINARY_DIR}/node_mavlink")
# In virtual time, so no machine is too slow.
ergocast_test(NAME mavlink_fleet_tests LABELS lab OPTIMISED
  SOURCES bridges/mavlink/fleet.cc bridges/mavlink/fleet_test.cc
  LIBS ergocast_mavlink ergocast_lab
  PROPERTIES FIXTURES_REQUIRED node_mavlink COST 60)
target_compile_definitions(mavlink_fleet_tests PRIVATE ERGOCAST_NODE_MAVLINK="${CMAKE_BINARY_DIR}/node_mavlink")
if(TARGET ergocast_example_mujoco)
  ergocast_test(NAME mavlink_quadrotor_tests LABELS lab OPTIMISED
    SOURCES bridges/mavlink/fleet.cc bridges/mavlink/quadrotors_test.cc
    LIBS ergocast_mavlink ergocast_example_mujoco ergocast_lab
    PROPERTIES FIXTURES_REQUIRED node_mavlink COST 60)
  target_compile_definitions(mavlink_quadrotor_tests PRIVATE ERGOCAST_NODE_MAVLINK="${CMAKE_BINARY_DIR}/node_mavlink")
endif()
include(bridges/ros2/tests.cmake)
add_executable(cot-lines cli/cot/lines.cc)
target_link_libraries(cot-lines PRIVATE ergocast_tak ergocast::plan nlohmann_json::nlohmann_json ergocast::warnings)
ergocast_script_test(cot_reference process cli/cot/reference_test.sh
  $<TARGET_FILE:cot-lines> ${CMAKE_BINARY_DIR}/node_cot)
# Fetches the client for foxglove_process_tests, whose network is their own.
ergocast_script_test(foxglove_client process cli/foxglove/client/fetch ${CMAKE_BINARY_DIR}/foxglove_client)
set_tests_properties(foxglove_client PROPERTIES FIXTURES_SETUP foxglove_client)
ergocast_script_test(example_law process examples/law_test.sh ${CMAKE_BINARY_DIR})
ergocast_script_test(setup_says_why process package/setup_test.sh)
ergocast_script_test(manual_pages process package/manual_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
ergocast_script_test(bash_completes process package/completion_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
ergocast_script_test(package_repository process package/repository_test.sh ${CMAKE_BINARY_DIR})
add_dependencies(all_process manual)
# Installing Slurm starts services, so ./test does not install it.
find_program(SLURMCTLD slurmctld PATHS /usr/sbin)
if(SLURMCTLD)
  ergocast_script_test(slurm_job_array hosts slurm/study_test.sh
    ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${CMAKE_SOURCE_DIR})
endif()
ergocast_nightly_script_test(package_installs package package/install_test.sh ${CMAKE_BINARY_DIR})
if(TARGET ergocast_python)
  ergocast_nightly_script_test(package_libraries package package/libraries_test.sh ${CMAKE_BINARY_DIR})
endif()
if(TARGET ergocast_python)
  ergocast_nightly_script_test(package_pip package package/pip_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
endif()
ergocast_nightly_script_test(package_lintian package package/lintian_test.sh ${CMAKE_BINARY_DIR})
# They compile the release, on both Debians, and for arm64.
foreach(suite bookworm trixie)
  ergocast_nightly_script_test(package_release_${suite} package package/release_test.sh ${CMAKE_BINARY_DIR})
  set_tests_properties(package_release_${suite} PROPERTIES ENVIRONMENT suite=${suite} TIMEOUT 14400)
endforeach()
ergocast_nightly_script_test(package_release_arm64 package package/release_test.sh ${CMAKE_BINARY_DIR})
set_tests_properties(package_release_arm64 PROPERTIES ENVIRONMENT arch=arm64 TIMEOUT 14400)
ergocast_nightly_script_test(package_arm64 package package/arm64_test.sh
  ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${CMAKE_SOURCE_DIR})
ergocast_nightly_script_test(package_services package package/services_test.sh ${CMAKE_BINARY_DIR})
ergocast_nightly_script_test(containers docker docker/docker_test.sh ${CMAKE_BINARY_DIR})

# The same programs between several network stacks.
ergocast_test(NAME hosts_tests LABELS hosts RUNS_PROGRAMS
  SOURCES
    hosts/doctor_test.cc
    hosts/fragments_test.cc
    hosts/lan_test.cc
    hosts/loss_test.cc
    hosts/partition_test.cc
    hosts/relay_test.cc
    hosts/takeover_test.cc
    hosts/team_test.cc
    hosts/wrong_network_test.cc
    checks_can_fail/doctor_test.cc
    checks_can_fail/words.cc
    support/lan.cc
  LIBS ergocast_doctor)
add_library(unsynchronised_clock SHARED support/unsynchronised_clock.cc)
add_dependencies(hosts_tests no_socket_filter unsynchronised_clock)
target_compile_definitions(hosts_tests PRIVATE
  ERGOCAST_NO_SOCKET_FILTER="$<TARGET_FILE:no_socket_filter>"
  ERGOCAST_UNSYNCHRONISED_CLOCK="$<TARGET_FILE:unsynchronised_clock>")

# ./test itself.
add_test(NAME verdict
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/verdict_test.sh ${CMAKE_SOURCE_DIR})
set_tests_properties(verdict PROPERTIES LABELS unit)

add_test(NAME prose_can_fail
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/checks_can_fail/prose_test.sh ${CMAKE_SOURCE_DIR})
set_tests_properties(prose_can_fail PROPERTIES LABELS unit)

if(TARGET ergocast_python)
  add_subdirectory(python)
endif()
add_subdirectory(spy)
add_subdirectory(documents)
