"""Draws every sample of recursive forms anew."""

import figure4
import figure7
import figures8and9

figure4.draw()
figure7.draw()
figures8and9.draw()
