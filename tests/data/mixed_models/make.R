# Makes trials.csv and tests.csv beside this script: studies of persons who repeat, and what
# lme4 and lmerTest (type III, Kenward and Roger by pbkrtest) find in them. Rscript make.R
suppressMessages({library(lmerTest)})
options(contrasts = c("contr.sum", "contr.poly"), digits = 12)
study <- function(name, persons, shoes, floors, sides, missing, group, seed) {
  set.seed(seed)
  d <- expand.grid(trial = 1:3, side = letters[1:sides], floor = letters[1:floors],
                   shoe = letters[1:shoes], person = 1:persons)
  react <- function(x) rnorm(nlevels(factor(x)), 0, 0.012)[factor(x)]
  d$y <- 0.2 + rnorm(persons, 0, 0.03)[d$person] + rnorm(nrow(d), 0, 0.008) +
    react(interaction(d$person, d$shoe)) + react(interaction(d$person, d$floor)) +
    react(interaction(d$person, d$side)) + react(interaction(d$person, d$shoe, d$floor, d$side))
  for (two in list(c("shoe", "floor"), c("shoe", "side"), c("floor", "side")))
    d$y <- d$y + react(interaction(d$person, d[[two[1]]], d[[two[2]]]))
  d$y <- round(d$y, 4)
  d$group <- letters[1 + d$person %% group]
  d <- d[runif(nrow(d)) >= missing, ]
  d$study <- name
  d
}
studies <- list(
  study("shoe and floor", 9, 3, 2, 1, 0, 1, 1),
  study("trials missing", 9, 3, 2, 1, 0.25, 1, 5),
  study("a group", 12, 3, 2, 1, 0.25, 2, 3),
  study("three within", 14, 3, 2, 2, 0.15, 1, 8))
models <- list(
  y ~ shoe * floor + (1 | person) + (1 | person:shoe) + (1 | person:floor) + (1 | person:shoe:floor),
  y ~ shoe * floor + (1 | person) + (1 | person:shoe) + (1 | person:floor) + (1 | person:shoe:floor),
  y ~ shoe * floor * group + (1 | person) + (1 | person:shoe) + (1 | person:floor) +
    (1 | person:shoe:floor),
  y ~ shoe * floor * side + (1 | person) + (1 | person:shoe) + (1 | person:floor) +
    (1 | person:side) + (1 | person:shoe:floor) + (1 | person:shoe:side) +
    (1 | person:floor:side) + (1 | person:shoe:floor:side))
tight <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-9, maxfun = 1e6))
tests <- NULL
for (i in seq_along(studies)) {
  d <- studies[[i]]
  d$person <- factor(d$person)
  fit <- lmer(models[[i]], d, control = tight)
  message(d$study[1], ": singular ", isSingular(fit))
  a <- anova(fit, type = 3, ddf = "Kenward-Roger")
  tests <- rbind(tests, data.frame(study = d$study[1], term = rownames(a), df = a$NumDF,
                                   error_df = a$DenDF, f = a$`F value`, p = a$`Pr(>F)`))
}
here <- sub("--file=", "", grep("--file=", commandArgs(), value = TRUE))
folder <- dirname(here)
all <- do.call(rbind, studies)[, c("study", "person", "shoe", "floor", "side", "group", "y")]
write.csv(all, file.path(folder, "trials.csv"), row.names = FALSE, quote = FALSE)
write.csv(tests, file.path(folder, "tests.csv"), row.names = FALSE, quote = FALSE)
message(R.version.string, ", pbkrtest ", packageVersion("pbkrtest"), ", lme4 ", packageVersion("lme4"), ", lmerTest ", packageVersion("lmerTest"))
