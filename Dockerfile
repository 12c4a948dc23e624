# syntax=docker/dockerfile:1
FROM rust:1.95-bookworm AS build
WORKDIR /src
# `tests` is a member of the workspace, which cargo reads as a whole, and has the reference cases, which the service holds, as it does
# the examples of its document.
COPY Cargo.toml Cargo.lock ./
COPY crates crates
COPY tests tests
COPY openapi/examples openapi/examples
# What is downloaded and compiled stays on the builder, so that a change compiles the changed crates alone. The folders are not
# part of the image: the program is copied out of them.
RUN --mount=type=cache,target=/usr/local/cargo/registry \
    --mount=type=cache,target=/src/target \
    cargo build --release --locked --package reentry-service && cp target/release/reentry /usr/local/bin/reentry

# Of the same Debian as the build, with nothing but the C library: no shell, and a user without rights.
FROM gcr.io/distroless/cc-debian12:nonroot
COPY --from=build /usr/local/bin/reentry /usr/local/bin/reentry
USER 65532
ENV REENTRY_LISTEN=0.0.0.0:8080
EXPOSE 8080
# The program asks itself: there is no curl.
HEALTHCHECK --interval=10s --timeout=5s CMD ["/usr/local/bin/reentry", "healthcheck"]
ENTRYPOINT ["/usr/local/bin/reentry"]
CMD ["serve"]
