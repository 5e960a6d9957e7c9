// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame-context FIFO: what a frame carries beside its numbers, from its first beat to the output. Sixteen frames deep.
//
// A context is pushed with a frame's first beat, and popped when the output stage begins the frame. All stages see the
// frames in one order, so each field is a FIFO for each of its readers:
//
// | field              | written                 | read              |
// |--------------------|-------------------------|-------------------|
// | timestamp, dropped | with the first beat     | output            |
// | contact, noise     | when calibration begins | CeAn              |
// | version, replaced  | when calibration begins | output            |
// | exponent           | when the scale is found | estimator, output |
// | variance           | when it is averaged     | estimator         |
//
// The timestamp counts cycles, modulo 2^32: 0 is the first cycle after the core's reset. A register resets this module
// a cycle later. Outputs are valid in the same cycle; the thresholds pass a register.

`default_nettype none

module sptfra_frame_context #(
    // 1: contexts hold whether frames were dropped
    parameter DROPS = 0,
    // 1: contexts hold thresholds, version and replaced taxels of a calibration
    parameter CALIBRATED = 0,
    // 1: contexts hold an exponent
    parameter SCALED = 0,
    // 1: contexts hold the variance of the noise left in an average
    parameter AVERAGED = 0
) (
    input  wire clock,
    input  wire reset,
    // Stream in: beats of frames that are accepted
    input  wire in_taken,
    input  wire in_last,
    input  wire in_dropped, // with a first beat: frames before this one were dropped
    // A frame's calibration begins
    input  wire calibrated,
    input  wire [31:0] in_contact,
    input  wire [26:0] in_noise,
    input  wire [7:0] in_version,
    input  wire [3:0] in_replaced,
    // A frame's scale is found
    input  wire scaled,
    input  wire [4:0] in_exponent,
    // A frame is averaged: {one cycle, variance}
    input  wire [25:0] smoothed,
    // CeAn: thresholds of the frame whose stress comes next or is coming
    input  wire cean_take,
    output wire [31:0] contact,
    output wire [26:0] noise,
    // Estimator: of the frame whose direction it takes next
    input  wire direction_take,
    output wire [4:0] direction_exponent,
    output wire [24:0] direction_variance,
    // Output: of the oldest frame
    input  wire take,
    output wire [31:0] timestamp,
    output wire dropped,
    output wire [7:0] version,
    output wire [3:0] replaced,
    output wire [4:0] exponent
);

    // ---- First beats
    localparam BEGIN_BITS = (DROPS != 0) ? 33 : 32;

    reg [31:0] now;
    reg in_frame;
    wire begins = in_taken && !in_frame;
    wire [32:0] begins_with = {in_dropped, now};
    wire [BEGIN_BITS-1:0] began_with;

    assign timestamp = began_with[31:0];
    assign dropped = (DROPS != 0) && began_with[BEGIN_BITS-1];

    sptfra_context_field #(
        .WIDTH (BEGIN_BITS)
    ) beginnings (
        .clock      (clock),
        .reset      (reset),
        .write      (begins),
        .write_data (begins_with[BEGIN_BITS-1:0]),
        .take       (take),
        .oldest     (began_with)
    );

    always @(posedge clock) begin
        now <= now + 32'd1;
        if (in_taken) begin
            in_frame <= !in_last;
        end
        if (reset) begin
            now <= 32'd1;
            in_frame <= 1'b0;
        end
    end

    // ---- Calibration
    if (CALIBRATED != 0) begin : gen_calibration
        wire [58:0] of_cean;
        reg [58:0] thresholds;

        assign {contact, noise} = thresholds;

        always @(posedge clock) begin
            thresholds <= of_cean;
        end

        sptfra_context_field #(
            .WIDTH (59)
        ) for_cean (
            .clock      (clock),
            .reset      (reset),
            .write      (calibrated),
            .write_data ({in_contact, in_noise}),
            .take       (cean_take),
            .oldest     (of_cean)
        );

        sptfra_context_field #(
            .WIDTH (12)
        ) for_output (
            .clock      (clock),
            .reset      (reset),
            .write      (calibrated),
            .write_data ({in_version, in_replaced}),
            .take       (take),
            .oldest     ({version, replaced})
        );
    end else begin : gen_constant
        assign contact = 32'd0;
        assign noise = 27'd0;
        assign version = 8'd0;
        assign replaced = 4'd0;
        wire _unused_calibration = &{1'b0, calibrated, in_contact, in_noise, in_version, in_replaced, cean_take};
    end

    // ---- Scale
    if (SCALED != 0) begin : gen_scale
        sptfra_context_field #(
            .WIDTH (5)
        ) for_direction (
            .clock      (clock),
            .reset      (reset),
            .write      (scaled),
            .write_data (in_exponent),
            .take       (direction_take),
            .oldest     (direction_exponent)
        );

        sptfra_context_field #(
            .WIDTH (5)
        ) for_output (
            .clock      (clock),
            .reset      (reset),
            .write      (scaled),
            .write_data (in_exponent),
            .take       (take),
            .oldest     (exponent)
        );
    end else begin : gen_unscaled
        assign direction_exponent = 5'd0;
        assign exponent = 5'd0;
        wire _unused_scale = &{1'b0, scaled, in_exponent, direction_take};
    end

    // ---- Noise left
    if (AVERAGED != 0) begin : gen_variance
        sptfra_context_field #(
            .WIDTH (25)
        ) for_direction (
            .clock      (clock),
            .reset      (reset),
            .write      (smoothed[25]),
            .write_data (smoothed[24:0]),
            .take       (direction_take),
            .oldest     (direction_variance)
        );
    end else begin : gen_frames_alone
        assign direction_variance = 25'd0;
        wire _unused_variance = &{1'b0, smoothed, direction_take};
    end

    wire _unused_begins = &{1'b0, begins_with};

endmodule

`default_nettype wire
