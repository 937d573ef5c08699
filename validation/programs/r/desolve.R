# deSolve's lsodar and radau with their own root finding, run by percuss.
#
# `METHOD-default` is the first example of roots in the help page: a root function, the tolerances,
# and nothing else. `METHOD` is what an expert adds:
#
# - Root functions have no direction: the guard's rate says which a root has, and a root in the
#   other one is passed over.
# - Steps are at most an eighth of a forcing period and of a turn.
# - A guard that is zero where a mode begins, or where a run was interrupted, has the sign that it
#   has just after it until it has moved away by more than the tolerance hides.
# - What follows an event is told by the first derivative that is not zero.
# - The Jacobian is given, and there is no limit on steps between outputs.

here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE)))
source(file.path(here, "percuss_program.R"))

MAX_STEP_PERIODS <- 0.125

# Runs to the next root, or to the horizon.
stretch <- function(course, method, known) {
  times <- unique(c(course$t, due(course, course$run$span), course$run$span))
  times <- times[times >= course$t]
  count <- length(course$modes[[course$mode]]$events)
  course$left <- rep(Inf, count)
  tolerance <- course$run$tolerance
  arguments <- list(
    y = course$z,
    times = times,
    func = function(t, z, parms) list(rates(course, t, z)),
    parms = NULL,
    rtol = tolerance$relative,
    atol = tolerance$absolute
  )
  if (count > 0) {
    arguments$rootfunc <- function(t, z, parms) {
      vapply(seq_len(count), function(n) guard(course, n, t, z, known[[n]]), 0)
    }
  }
  if (!is.null(known)) arguments <- c(arguments, expert_options(course, method))
  do.call(method, arguments)
}

expert_options <- function(course, method) {
  mode <- course$modes[[course$mode]]
  inside <- seq_len(mode$size)
  turn <- if (is.null(course$run$times$turn)) Inf else course$run$times$turn
  list(
    hmax = MAX_STEP_PERIODS * min(course$run$times$period, turn),
    maxsteps = 1e6,
    jacfunc = function(t, z, parms) {
      course$jacobians <- course$jacobians + 1
      mode$wide[inside, inside, drop = FALSE]
    }
  )
}

# Takes over what was found: the samples before the root, and which guards have one there.
take <- function(course, out) {
  if (attr(out, "istate")[1] < 0 && is.null(attr(out, "troot"))) stop("the method gave up")
  steps <- attr(out, "istate")[2]
  if (!is.na(steps)) course$steps <- course$steps + steps
  last <- nrow(out)
  t <- out[last, 1]
  for (n in seq_len(last)) {
    if (n < last && out[n, 1] %in% due(course, out[n, 1])) sample_state(course, unname(out[n, -1]))
  }
  list(t = unname(t), z = unname(out[last, -1]), roots = which(attr(out, "iroot") != 0))
}

by_default <- function(course, method) {
  while (goes_on(course)) {
    found <- take(course, stretch(course, method, NULL))
    events <- course$modes[[course$mode]]$events
    ends <- Filter(function(n) events[[n]]$ends, found$roots)
    for (n in setdiff(found$roots, ends)) report(course, found$t, n, course$mode, found$z)
    if (length(ends) > 0) {
      pass(course, found$t, ends[1], found$z, plainly = TRUE)
    } else {
      course$t <- found$t
      course$z <- found$z
    }
  }
}

by_experts <- function(course, method) {
  entry <- enter(course)
  while (goes_on(course)) {
    events <- course$modes[[course$mode]]$events
    if (length(entry$fires) > 0) {
      pass(course, course$t, entry$fires, course$z)
      entry <- enter(course, events[[entry$fires]])
      next
    }
    found <- take(course, stretch(course, method, entry$known))
    # Which way each guard goes that has a root here.
    matrix <- course$modes[[course$mode]]$wide
    wide <- wide_of(course, found$t, found$z)
    way <- vapply(events, function(event) sign(sum(event$row %*% matrix * wide)), 0)
    counts <- function(n) events[[n]]$sign == 0 || events[[n]]$sign == way[n]
    roots <- Filter(counts, found$roots)
    ends <- Filter(function(n) events[[n]]$ends, roots)
    for (n in setdiff(roots, ends)) report(course, found$t, n, course$mode, found$z)
    if (length(ends) > 0) {
      pass(course, found$t, ends[1], found$z)
      entry <- enter(course, events[[ends[1]]])
    } else {
      course$t <- found$t
      course$z <- found$z
      # Its roots are where the next stretch begins.
      known <- lapply(events, function(event) list(order = 0, sign = 0))
      for (n in found$roots) known[[n]] <- list(order = 1, sign = way[n])
      entry <- list(known = known, fires = integer())
    }
  }
}

make <- function(setup, course) {
  method <- sub("-default$", "", setup)
  if (method == setup) by_experts(course, method) else by_default(course, method)
}

setups <- function() {
  methods <- c(lsodar = "Adams and BDF, switching", radau = "Radau IIA of order 5")
  classes <- c(lsodar = "multistep", radau = "implicit")
  one <- function(name, suffix) {
    list(
      name = paste0(name, suffix), method = methods[[name]], class = classes[[name]],
      events = "library", dense_output = TRUE, stepping = "adaptive"
    )
  }
  names <- rep(names(methods), each = 2)
  unname(Map(one, names, rep(c("", "-default"), 2)))
}

installed <- suppressWarnings(requireNamespace("deSolve", quietly = TRUE))
if (!installed) {
  id <- jsonlite::fromJSON(readLines(file("stdin", "r"), 1))$id
  cat(sprintf('{"percuss_protocol":1,"id":%d,"unavailable":"deSolve is not installed"}\n', id))
  quit()
}
library(deSolve)
serve("deSolve", as.character(packageVersion("deSolve")), setups(), make)
