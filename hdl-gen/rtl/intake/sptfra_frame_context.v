// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame-context FIFO: what a frame carries beside its numbers, from its first beat to the output. Sixteen frames deep.
//
// A context is pushed with a frame's first beat, and popped when the output stage begins the frame. All stages see the
// frames in one order, so each field has a write pointer, and each reader a read pointer:
//
// | field              | written                 | read              |
// |--------------------|-------------------------|-------------------|
// | timestamp, dropped | with the first beat     | output            |
// | contact, noise     | when calibration begins | CeAn              |
// | version, replaced  | when calibration begins | output            |
// | exponent           | when the scale is found | estimator, output |
//
// The timestamp counts cycles from the reset, modulo 2^32: 0 is the first cycle after that of the core, whose register
// resets this module a cycle later. Outputs are valid in the same cycle; the thresholds pass a register.

`default_nettype none

module sptfra_frame_context #(
    // 1: contexts hold whether frames were dropped
    parameter DROPS = 0,
    // 1: contexts hold thresholds, version and replaced taxels of a calibration
    parameter CALIBRATED = 0,
    // 1: contexts hold an exponent
    parameter SCALED = 0
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
    // CeAn: thresholds of the frame whose stress comes next or is coming
    input  wire cean_take,
    output wire [31:0] contact,
    output wire [26:0] noise,
    // Estimator: of the frame whose direction it takes next
    input  wire direction_take,
    output wire [4:0] direction_exponent,
    // Output: of the oldest frame
    input  wire take,
    output wire [31:0] timestamp,
    output wire dropped,
    output wire [7:0] version,
    output wire [3:0] replaced,
    output wire [4:0] exponent
);

    // ---- Pushed with the first beat, popped by the output
    localparam BEGIN_BITS = (DROPS != 0) ? 33 : 32;

    reg [31:0] now;
    reg in_frame;
    reg [3:0] newest;
    reg [3:0] oldest;
    wire begins = in_taken && !in_frame;
    wire [32:0] begins_with = {in_dropped, now};
    wire [BEGIN_BITS-1:0] began_with;

    assign timestamp = began_with[31:0];
    assign dropped = (DROPS != 0) && began_with[BEGIN_BITS-1];

    sptfra_context_words #(
        .WIDTH (BEGIN_BITS)
    ) beginnings (
        .clock       (clock),
        .write       (begins),
        .write_frame (newest),
        .write_data  (begins_with[BEGIN_BITS-1:0]),
        .read_frame  (oldest),
        .read_data   (began_with)
    );

    always @(posedge clock) begin
        now <= now + 32'd1;
        if (in_taken) begin
            in_frame <= !in_last;
        end
        if (begins) begin
            newest <= newest + 4'd1;
        end
        if (take) begin
            oldest <= oldest + 4'd1;
        end
        if (reset) begin
            now <= 32'd1;
            in_frame <= 1'b0;
            newest <= 4'd0;
            oldest <= 4'd0;
        end
    end

    // ---- Calibration
    generate
        if (CALIBRATED != 0) begin : gen_calibration
            reg [3:0] next_calibrated;
            reg [3:0] next_cean;
            wire [58:0] of_cean;
            reg [58:0] thresholds;

            assign {contact, noise} = thresholds;

            sptfra_context_words #(
                .WIDTH (59)
            ) for_cean (
                .clock       (clock),
                .write       (calibrated),
                .write_frame (next_calibrated),
                .write_data  ({in_contact, in_noise}),
                .read_frame  (next_cean),
                .read_data   (of_cean)
            );

            sptfra_context_words #(
                .WIDTH (12)
            ) for_output (
                .clock       (clock),
                .write       (calibrated),
                .write_frame (next_calibrated),
                .write_data  ({in_version, in_replaced}),
                .read_frame  (oldest),
                .read_data   ({version, replaced})
            );

            always @(posedge clock) begin
                thresholds <= of_cean;
                if (calibrated) begin
                    next_calibrated <= next_calibrated + 4'd1;
                end
                if (cean_take) begin
                    next_cean <= next_cean + 4'd1;
                end
                if (reset) begin
                    next_calibrated <= 4'd0;
                    next_cean <= 4'd0;
                end
            end
        end else begin : gen_constant
            assign contact = 32'd0;
            assign noise = 27'd0;
            assign version = 8'd0;
            assign replaced = 4'd0;
            wire _unused_calibration = &{1'b0, calibrated, in_contact, in_noise, in_version, in_replaced, cean_take};
        end
    endgenerate

    // ---- Scale
    generate
        if (SCALED != 0) begin : gen_scale
            reg [3:0] next_scaled;
            reg [3:0] next_direction;

            sptfra_context_words #(
                .WIDTH (5)
            ) for_direction (
                .clock       (clock),
                .write       (scaled),
                .write_frame (next_scaled),
                .write_data  (in_exponent),
                .read_frame  (next_direction),
                .read_data   (direction_exponent)
            );

            sptfra_context_words #(
                .WIDTH (5)
            ) for_output (
                .clock       (clock),
                .write       (scaled),
                .write_frame (next_scaled),
                .write_data  (in_exponent),
                .read_frame  (oldest),
                .read_data   (exponent)
            );

            always @(posedge clock) begin
                if (scaled) begin
                    next_scaled <= next_scaled + 4'd1;
                end
                if (direction_take) begin
                    next_direction <= next_direction + 4'd1;
                end
                if (reset) begin
                    next_scaled <= 4'd0;
                    next_direction <= 4'd0;
                end
            end

`ifdef SIMULATION
            always @(posedge clock) begin
                if (!reset && direction_take && (next_direction == next_scaled)) begin
                    $fdisplay(32'h80000002, "%m: a frame is taken before its scale is known");
                    $fatal(1);
                end
            end
`endif
        end else begin : gen_unscaled
            assign direction_exponent = 5'd0;
            assign exponent = 5'd0;
            wire _unused_scale = &{1'b0, scaled, in_exponent, direction_take};
        end
    endgenerate

    wire _unused_begins = &{1'b0, begins_with};

`ifdef SIMULATION
    // A frame leaves after it has come, and no more are inside than there is room for
    reg [4:0] held;

    always @(posedge clock) begin
        held <= held + {4'd0, begins} - {4'd0, take};
        if (reset) begin
            held <= 5'd0;
        end else if ((take && (held == 5'd0)) || (begins && (held == 5'd16))) begin
            $fdisplay(32'h80000002, "%m: a frame leaves that has not come, or more are inside than there is room for");
            $fatal(1);
        end
    end
`endif

endmodule

`default_nettype wire
