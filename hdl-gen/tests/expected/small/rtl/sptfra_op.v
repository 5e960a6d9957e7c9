// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Op: the estimator's answer to forces, and the frame out.
//
// Two stations, each with a frame of its own: the summary (friction, resultants) and the output, which puts the field
// together on the way out. The estimator stands before them.

`default_nettype none

module sptfra_op #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // 1: the forces of all taxels go out too; 0: resultants only
    parameter integer FIELD = 1,
    // 1: the answer's other component is other + slope * free; 0: it is as it comes
    parameter integer DEPENDENT = 1,
    // 1: the design has dead taxels, whose readings others replace
    parameter integer REPLACED = 0,
    // A step of the frame sums G is 2^SUM_LSB N, one of a taxel's force 2^FIELD_LSB N
    parameter integer SUM_LSB = -40,
    parameter integer FIELD_LSB = -50,
    // From the answer's taking to the end of the summary, checked in simulation; 0: unchecked
    parameter integer EXPECTED_SUMMARY_LATENCY = 0,
    // From the start of the output to its first beat, checked in simulation; 0: unchecked
    parameter integer EXPECTED_OUTPUT_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // The estimator's answer
    input  wire answer_valid,
    output wire answer_take,
    input  wire x_is_free,
    input  wire signed [17:0] free,
    input  wire signed [17:0] other,
    input  wire signed [17:0] slope,
    input  wire unknown,
    input  wire at_bound,
    input  wire search_saturated,
    input  wire [9*40-1:0] sums,
    input  wire [4:0] flags, // too much replaced, no contact, saturated, NaN or infinity, bad length
    // To the lanes: the friction of the frame in the summary
    output reg  friction_known, // and held, until the field is started
    input  wire field_start,
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    // Field memory: the friction of the frame at the output, and its field, a component at a time
    input  wire field_complete, // one cycle: a frame's field is there
    output wire signed [17:0] field_mu_x,
    output wire signed [17:0] field_mu_y,
    output wire field_enable,
    output wire field_rewind,
    output wire field_step,
    output wire field_release, // the frame's place is free again
    input  wire signed [63:0] field_value,
    // Stream out
    output wire [31:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready
);

    localparam integer FRICTION_FRACTION = 16;

    // ---- Summary
    reg summary_unknown;
    reg summary_x_is_free;
    reg signed [17:0] summary_free;
    reg signed [17:0] summary_other;
    reg signed [17:0] summary_slope;
    reg [9*40-1:0] summary_sums;
    reg [4:0] summary_flags;
    reg summary_at_bound;
    reg summary_saturated;
    reg summary_busy;
    reg summary_there;
    reg [1:0] fields_there; // that no output has begun of: without a friction to wait for, two
    wire friction_done;
    wire summary_done;
    wire dependent_clipped;
    wire signed [63:0] force_x;
    wire signed [63:0] force_y;
    wire signed [63:0] force_z;
    wire [63:0] friction_quotient;
    wire signed [9:0] friction_exponent;
    wire signed [31:0] angle;
    wire output_idle;
    wire output_start = summary_there && output_idle && ((FIELD == 0) || (fields_there != 2'd0));

    assign answer_take = answer_valid && !summary_busy;

    always @(posedge clock) begin
        if (answer_take) begin
            summary_busy <= 1'b1;
            summary_unknown <= unknown;
            summary_x_is_free <= x_is_free;
            summary_free <= free;
            summary_other <= other;
            summary_slope <= slope;
            summary_sums <= sums;
            summary_flags <= flags;
            summary_at_bound <= at_bound;
            summary_saturated <= search_saturated;
        end
        if (summary_done) begin
            summary_there <= 1'b1;
        end
        if (friction_done) begin
            friction_known <= 1'b1;
        end
        if (field_start) begin
            friction_known <= 1'b0;
        end
        fields_there <= fields_there + {1'b0, field_complete} - {1'b0, output_start && (FIELD != 0)};
        if (output_start) begin
            summary_busy <= 1'b0;
            summary_there <= 1'b0;
        end
        if (reset) begin
            summary_busy <= 1'b0;
            summary_there <= 1'b0;
            friction_known <= 1'b0;
            fields_there <= 2'd0;
        end
    end

    sptfra_summary #(
        .DEPENDENT        (DEPENDENT),
        .EXPECTED_LATENCY (EXPECTED_SUMMARY_LATENCY)
    ) summary (
        .clock             (clock),
        .reset             (reset),
        .start             (answer_take),
        .sums              (summary_sums),
        .x_is_free         (summary_x_is_free),
        .unknown           (summary_unknown),
        .free              (summary_free),
        .other             (summary_other),
        .slope             (summary_slope),
        .friction_done     (friction_done),
        .done              (summary_done),
        .mu_x              (mu_x),
        .mu_y              (mu_y),
        .dependent_clipped (dependent_clipped),
        .force_x           (force_x),
        .force_y           (force_y),
        .force_z           (force_z),
        .friction_quotient (friction_quotient),
        .friction_exponent (friction_exponent),
        .angle             (angle)
    );

    // ---- Status: a frame that cannot be trusted says why, and nothing else
    wire no_contact = summary_flags[3];
    wire not_finite = summary_flags[1];
    wire bad_length = summary_flags[0];
    wire bad = not_finite || bad_length;
    wire answered = !bad && !no_contact;
    wire [9:0] status = {
        answered && summary_flags[4],
        answered && (REPLACED != 0),
        2'b00,
        bad_length,
        not_finite,
        answered && (summary_flags[2] || summary_saturated),
        answered && !summary_unknown && (summary_at_bound || dependent_clipped),
        answered && summary_unknown,
        !bad && no_contact
    };

    // ---- Output
    sptfra_output #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .FIELD            (FIELD),
        .FORCE_LSB        (SUM_LSB - FRICTION_FRACTION),
        .FIELD_LSB        (FIELD_LSB),
        .EXPECTED_LATENCY (EXPECTED_OUTPUT_LATENCY)
    ) frame_output (
        .clock             (clock),
        .reset             (reset),
        .start             (output_start),
        .idle              (output_idle),
        .status            (status),
        .blank             (!answered),
        .force_x           (force_x),
        .force_y           (force_y),
        .force_z           (force_z),
        .friction_quotient (friction_quotient),
        .friction_exponent (friction_exponent),
        .angle             (angle),
        .mu_x              (mu_x),
        .mu_y              (mu_y),
        .field_mu_x        (field_mu_x),
        .field_mu_y        (field_mu_y),
        .field_enable      (field_enable),
        .field_rewind      (field_rewind),
        .field_step        (field_step),
        .field_release     (field_release),
        .field_value       (field_value),
        .m_tdata           (m_tdata),
        .m_tlast           (m_tlast),
        .m_tvalid          (m_tvalid),
        .m_tready          (m_tready)
    );

endmodule

`default_nettype wire
