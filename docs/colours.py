"""The colours of all pictures: dark enough on white for words, and apart in hue; grey tells them by line and marker."""

BLUE, ORANGE, RED, WALL = "#0072b2", "#b85000", "#b22222", "#7a6a3a"
GREEN, PURPLE = "#007a58", "#a8568c"
INK, GREY, PALE = "#222222", "#555555", "#cfe3f1"
