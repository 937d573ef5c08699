# Programs that percuss runs as engines, for R: the protocol, and a system's equations.
#
# A program calls `serve` with what it can do and with a function that makes a run. The protocol is
# described in docs/PROTOCOL.md; what it counts from 0 is counted from 1 here.

ROUNDING <- 1024 * .Machine$double.eps
INSTANT_TOLERANCE <- 8 * .Machine$double.eps
MAX_SIMULTANEOUS_EVENTS <- 64
# So many stretches in so little of a run are one event that is found again and again.
MAX_STRETCHES <- 200
PROGRESS_TOLERANCE <- 1e-9
# How much of a guard that was zero where its mode begins the first steps may hide, in tolerances:
# of a simple zero, which it leaves at once, and of a multiple one, which it leaves slowly.
SIMPLE_ZERO_TOLERANCES <- 0.1
MULTIPLE_ZERO_TOLERANCES <- 10

numbers <- function(list) as.numeric(unlist(list))
rows <- function(list) do.call(rbind, lapply(list, numbers))

read_event <- function(wire, size) {
  reset <- diag(size + 3)
  if (!is.null(wire$reset)) reset[seq_len(size), ] <- rows(wire$reset)
  list(
    row = numbers(wire$guard),
    sign = c(rising = 1, falling = -1, both = 0)[[wire$direction]],
    ends = length(wire$successors) > 0,
    reset = reset,
    successors = lapply(wire$successors, function(it) {
      list(when = if (is.null(it$when)) NULL else numbers(it$when), mode = it$mode + 1)
    })
  )
}

# A mode: w' = M w, with w = (z, cos theta, sin theta, 1).
read_mode <- function(wire, omega) {
  size <- length(wire$c)
  wide <- matrix(0, size + 3, size + 3)
  wide[seq_len(size), ] <- cbind(rows(wire$A), rows(wire$B), numbers(wire$c))
  wide[size + 1, size + 2] <- -omega
  wide[size + 2, size + 1] <- omega
  list(size = size, wide = wide, events = lapply(wire$events, read_event, size = size))
}

# A run as it is made; an environment, because it changes.
new_course <- function(run) {
  course <- new.env()
  course$run <- run
  course$omega <- run$system$omega
  course$phi <- run$system$phi
  course$modes <- lapply(run$system$modes, read_mode, omega = course$omega)
  course$t <- 0
  course$mode <- run$mode + 1
  course$z <- numbers(run$state)
  course$samples <- numbers(run$samples)
  course$sampled <- list()
  course$events <- list()
  course$ended <- NULL
  course$crowd <- 0
  course$stretches <- 0
  course$progress <- 0
  course$rhs <- course$jacobians <- course$steps <- 0
  course$deadline <- proc.time()[["elapsed"]] + run$limits$wall_s
  course
}

wide_of <- function(course, t, z) {
  theta <- course$omega * t + course$phi
  c(z, cos(theta), sin(theta), 1)
}

# Ends a run that goes beyond its limits.
give_up <- function(course, why) {
  course$gave_up <- why
  stop(why)
}

# The right-hand side in the mode of now.
rates <- function(course, t, z) {
  course$rhs <- course$rhs + 1
  if (course$rhs + course$jacobians > course$run$limits$calls) give_up(course, "too many calls")
  if (course$rhs %% 1024 == 0 && proc.time()[["elapsed"]] > course$deadline) {
    give_up(course, "the time is over")
  }
  mode <- course$modes[[course$mode]]
  as.vector(mode$wide[seq_len(mode$size), , drop = FALSE] %*% wide_of(course, t, z))
}

# Whether a row is a multiple of another one, of 0 at the least.
is_multiple <- function(row, of) {
  size <- sum(of * of)
  sqrt(sum((row * size - of * sum(row * of))^2)) <= 1e-12 * size * sqrt(sum(row^2))
}

# The order and the sign of the first derivative of row . w along a mode that is not zero. What is a
# multiple of the guard that was `passed` is zero there, whatever rounding says.
leading <- function(course, row, mode, t, z, passed = NULL) {
  w <- wide_of(course, t, z)
  for (order in seq_along(w) - 1) {
    known <- !is.null(passed) && is_multiple(as.vector(row %*% passed$reset), passed$row)
    value <- sum(row * w)
    if (!known && abs(value) > ROUNDING * sum(abs(row * w))) {
      return(list(order = order, sign = sign(value)))
    }
    row <- as.vector(row %*% course$modes[[mode]]$wide)
  }
  list(order = Inf, sign = 0)
}

# What is known of each guard where a mode begins, and the first that ends it at once.
enter <- function(course, passed = NULL) {
  known <- lapply(course$modes[[course$mode]]$events, function(event) {
    leading(course, event$row, course$mode, course$t, course$z, passed)
  })
  ends <- vapply(course$modes[[course$mode]]$events, function(event) event$ends, TRUE)
  rises <- vapply(known, function(it) it$sign > 0, TRUE)
  list(known = known, fires = head(which(ends & rises), 1))
}

# A guard; one that was zero where the mode begins has the sign that it has just after it until it
# has moved away by more than the tolerance hides. `course$left` keeps when that was: coming back it
# is itself.
guard <- function(course, place, t, z, known = NULL) {
  event <- course$modes[[course$mode]]$events[[place]]
  value <- sum(event$row * wide_of(course, t, z))
  if (is.null(known) || known$order == 0 || t >= course$left[place]) return(value)
  if (known$sign == 0) return(-1)
  tolerance <- course$run$tolerance
  errors <- tolerance$absolute + tolerance$relative * abs(z)
  tolerances <- if (known$order == 1) SIMPLE_ZERO_TOLERANCES else MULTIPLE_ZERO_TOLERANCES
  hidden <- tolerances * sum(abs(event$row[seq_along(z)]) * errors)
  if (abs(value) <= hidden) return(known$sign * 1e-300)
  if (sign(value) == known$sign) course$left[place] <- t
  value
}

# The instants that are wanted up to a time.
due <- function(course, until = Inf) {
  left <- tail(course$samples, length(course$samples) - length(course$sampled))
  left[left <= until]
}

sample_state <- function(course, z) course$sampled[[length(course$sampled) + 1]] <- z

# Reports an event and the state after it. `before` is the state before its reset; of an event that
# is only counted it is the state itself.
report <- function(course, t, place, mode, z, before = z) {
  if (length(course$events) >= course$run$limits$events) give_up(course, "too many events")
  event <- list(
    time = t, event = place - 1, mode = mode - 1, before = I(before), state = I(z)
  )
  course$events[[length(course$events) + 1]] <- event
}

# Goes through an event that ends its mode. `plainly` decides what follows by the signs of
# conditions alone, zero or not.
pass <- function(course, t, place, z, plainly = FALSE) {
  if (course$run$backward) {
    course$t <- t
    course$z <- z
    course$ended <- "leaves-domain"
    return()
  }
  event <- course$modes[[course$mode]]$events[[place]]
  before <- z
  after <- as.vector(event$reset %*% wide_of(course, t, before))
  z <- after[seq_along(before)]
  for (it in event$successors) {
    holds <- is.null(it$when) || (if (plainly) sum(it$when * after) > 0 else
      leading(course, it$when, it$mode, t, z, event)$sign > 0)
    if (holds) break
  }
  report(course, t, place, it$mode, z, before)
  course$crowd <- if (t - course$t <= INSTANT_TOLERANCE * t) course$crowd + 1 else 1
  course$t <- t
  course$mode <- it$mode
  course$z <- z
  if (course$crowd >= MAX_SIMULTANEOUS_EVENTS) course$ended <- "no-progress"
}

# Whether the run has not come to its end; asked once a stretch.
goes_on <- function(course) {
  course$stretches <- course$stretches + 1
  if (course$t - course$progress > PROGRESS_TOLERANCE * course$run$span) {
    course$stretches <- 0
    course$progress <- course$t
  }
  if (course$stretches > MAX_STRETCHES) {
    stop(sprintf("events at %.17g are found again and again", course$t))
  }
  is.null(course$ended) && course$run$span - course$t > 2 * INSTANT_TOLERANCE * course$run$span
}

answer_run <- function(course, seconds) {
  if (is.null(course$ended)) for (t in due(course)) sample_state(course, course$z)
  if (!all(is.finite(c(course$z, unlist(course$sampled))))) stop("a state is not finite")
  list(
    events = course$events,
    samples = lapply(course$sampled, I),
    end = I(course$z),
    ended = if (is.null(course$ended)) "horizon" else course$ended,
    ended_at = if (is.null(course$ended)) course$run$span else course$t,
    work = list(rhs = course$rhs, jacobians = course$jacobians, steps = course$steps),
    own_ns = round(1e9 * seconds)
  )
}

# Answers requests until there are no more.
serve <- function(library, version, setups, make) {
  input <- file("stdin", "r")
  # What a library prints is no answer.
  sink(stderr())
  while (length(line <- readLines(input, 1)) > 0) {
    request <- jsonlite::fromJSON(line, simplifyVector = FALSE)
    answer <- list(percuss_protocol = 1, id = request$id)
    if (request$ask == "capabilities") {
      language <- paste0("R ", getRversion())
      answer$capabilities <-
        list(library = library, version = version, language = language, setups = setups)
    } else if (request$ask == "ready") {
      answer$ready <- TRUE
    } else {
      course <- new_course(request$run)
      answer <- c(answer, tryCatch(
        {
          for (t in due(course, 0)) sample_state(course, course$z)
          seconds <- system.time(make(request$run$setup, course), gcFirst = FALSE)[["elapsed"]]
          list(run = answer_run(course, seconds))
        },
        error = function(why) {
          if (is.null(course$gave_up)) list(failure = conditionMessage(why)) else
            list(gave_up = course$gave_up)
        }
      ))
    }
    sink()
    cat(jsonlite::toJSON(answer, auto_unbox = TRUE, digits = I(17)), "\n", sep = "")
    sink(stderr())
  }
}
