FROM rust:1.95-bookworm AS build
WORKDIR /src
# `tests` is a member of the workspace, which cargo reads as a whole; the service holds the examples of its document.
COPY Cargo.toml Cargo.lock ./
COPY crates crates
COPY tests tests
COPY openapi/examples openapi/examples
RUN cargo build --release --locked --package reentry-service

# Of the same Debian as the build, with nothing but the C library: no shell, and a user without rights.
FROM gcr.io/distroless/cc-debian12:nonroot
COPY --from=build /src/target/release/reentry /usr/local/bin/reentry
USER 65532
ENV REENTRY_LISTEN=0.0.0.0:8080
EXPOSE 8080
ENTRYPOINT ["/usr/local/bin/reentry"]
CMD ["serve"]
