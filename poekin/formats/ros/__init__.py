"""ROS without ROS: the text of /robot_description as its tools print it, and packages by name."""
