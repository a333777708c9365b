"""The shapes that disks can meet, one file each, and what every shape knows (`shape`)."""
