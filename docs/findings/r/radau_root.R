# deSolve: radau gives a root the time of the end of its step, with the state of the root.

library(deSolve)
cat("deSolve", as.character(packageVersion("deSolve")), "- y = sin t reaches 1/2 at t = 0.523599\n")
for (method in c("lsodar", "radau")) {
  found <- ode(
    c(y = 0), c(0, 3), function(t, y, p) list(cos(t)), NULL,
    method = method, rootfunc = function(t, y, p) y - 0.5, rtol = 1e-9, atol = 1e-9
  )
  end <- found[nrow(found), ]
  cat(sprintf("%s: the run ends at t = %.6f with y = %.6f\n", method, end[["time"]], end[["y"]]))
}
