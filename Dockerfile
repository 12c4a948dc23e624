# syntax=docker/dockerfile:1
FROM node:22-bookworm-slim AS page
WORKDIR /src/crates/service/ui
COPY crates/service/ui/package.json crates/service/ui/package-lock.json ./
RUN --mount=type=cache,target=/root/.npm npm ci --no-audit --no-fund
COPY openapi /src/openapi
COPY tests/cases /src/tests/cases
COPY crates/service/ui ./
RUN npm run build

FROM rust:1.95-bookworm AS build
WORKDIR /src
# `tests` is a member of the workspace, which cargo reads as a whole, and has the reference cases, which the service holds, as it does
# the examples of its document.
COPY Cargo.toml Cargo.lock LICENSE-MIT LICENSE-APACHE ./
COPY crates crates
COPY tests tests
COPY openapi/examples openapi/examples
COPY openapi/answers openapi/answers
COPY --from=page /src/crates/service/ui/dist crates/service/ui/dist
# What is downloaded and compiled stays on the builder, so that a change compiles the changed crates alone. The folders are not
# part of the image: the program is copied out of them.
# The page is touched: one out of the builder's store may be older than what was compiled last, and pass for the same.
RUN --mount=type=cache,target=/usr/local/cargo/registry \
    --mount=type=cache,target=/src/target \
    touch crates/service/ui/dist && \
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
