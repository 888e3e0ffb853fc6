"""How a blur is made of one sharp picture that is seen at several places at once.

Out of focus a point is a bell, the same to all sides of the image; while the shutter is open it is drawn
along a line, evenly. On a tilted marker the bell is longer one way, and the line another.

Motion as a longer Gaussian of the same variance leaves a tenth of the contrast unexplained at 10 px: tips
of camera B were off by nine times the Cramer-Rao bound, against 1.2 times with the line.
"""
