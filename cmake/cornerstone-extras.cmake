# What cornerstone's headers include, for packages that find_package(catkin COMPONENTS cornerstone).
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d)
find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(mrpt-maps REQUIRED)
list(APPEND cornerstone_LIBRARIES ${OpenCV_LIBS} Eigen3::Eigen yaml-cpp mrpt::maps)
