# SPDX-License-Identifier: BSD-3-Clause
"""Starts the bridge, the frames of two_robots.textproto, and RViz: ros2 launch ergocast.launch.py"""
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).resolve().parent
# As in two_robots.textproto: x [m], y [m], yaw [rad].
STARTS = {"robot0/odom": ("5", "5", "1.5708"), "robot1/odom": ("15", "5", "1.5708")}


def frame(name, x, y, yaw):
    return Node(package="tf2_ros", executable="static_transform_publisher",
                arguments=["--frame-id", "map", "--child-frame-id", name, "--x", x, "--y", y, "--yaw", yaw])


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("file", default_value=str(HERE / "two_robots.textproto")),
        DeclareLaunchArgument("lcm_url", default_value="udpm://239.255.76.67:7667?ttl=1"),
        ExecuteProcess(cmd=["ergocast-ros2", LaunchConfiguration("file"), "--lcm-url", LaunchConfiguration("lcm_url")],
                       output="screen", sigterm_timeout="15"),
        *(frame(name, *start) for name, start in STARTS.items()),
        Node(package="rviz2", executable="rviz2"),
    ])
