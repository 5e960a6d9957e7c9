// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Op: last stage of a core, from the estimator's friction pair to the words of an answer.
//
// Two pipeline stages, each with a frame of its own. The summary computes friction and resultants. The output computes
// the field as it leaves.
//
// Latency from answer_take to the output's start, if it is idle and, with FIELD, the field is there:
// EXPECTED_SUMMARY_LATENCY + 1 cycles; from there to the first word EXPECTED_OUTPUT_LATENCY. Interval: that of the
// longer stage.

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
    // 1: the answer has an error; above ERROR_LIMIT, a logarithm of base 2 with 12 fraction bits, it has low confidence
    parameter integer WITH_ERROR = 0,
    parameter signed [17:0] ERROR_LIMIT = 18'sd0,
    // 1: the layer is too thin for the taxels, and every answer has low confidence
    parameter integer THIN = 0,
    // A step of the frame sums G is 2^SUM_LSB N, of those of the torques 2^TORQUE_LSB N m, of a taxel's force
    // 2^FIELD_LSB N
    parameter integer SUM_LSB = -40,
    parameter integer TORQUE_LSB = -45,
    parameter integer FIELD_LSB = -50,
    // 32-bit words of a beat out: 1, 2 or 4
    parameter integer WORDS = 1,
    // Enabled cycles from a step of the field memory to the forces
    parameter integer FIELD_STAGES = 6,
    // Friction at which a frame slips, and below which it no longer does if the frame before did, 16 fraction bits;
    // 0: none ever slips
    parameter [17:0] SLIP_LIMIT = 18'd0,
    parameter [17:0] SLIP_RELEASE = 18'd0,
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
    input  wire signed [17:0] error_log, // of base 2, of the error of (F_x, F_y) over |F_z|, 12 fraction bits
    input  wire unknown,
    input  wire at_bound,
    input  wire search_saturated,
    input  wire [18*40-1:0] sums, // these for a cycle after the taking, too
    input  wire [5:0] flags, // no tension, too much replaced, no contact, saturated, NaN or infinity, bad length
    // To the lanes: the friction of the frame in the summary
    output reg  friction_known, // and held, until the field is started
    input  wire field_start,
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    // Field memory: the friction of the frame at the output, and its field, a beat at a time
    input  wire field_complete, // one cycle: a frame's field is there
    output wire signed [17:0] field_mu_x,
    output wire signed [17:0] field_mu_y,
    output wire field_enable,
    output wire field_rewind,
    output wire field_step,
    output wire field_release, // the frame's place is free again
    input  wire [64*WORDS-1:0] field_value,
    // Contacts of the oldest frame of which no output has begun, which is taken with its context: 1 at least
    input  wire [7:0] contacts,
    // Context of the oldest frame inside: see sptfra_frame_context
    input  wire [31:0] timestamp,
    input  wire dropped, // frames before it
    input  wire [7:0] version, // of the calibration
    input  wire [3:0] replaced, // dead taxels
    input  wire [4:0] exponent, // of its scale
    output wire context_take,
    // Stream out
    output wire [32*WORDS-1:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready
);

    if (SLIP_RELEASE > SLIP_LIMIT) begin : gen_check_slip
        sptfra_error_a_slip_ends_below_its_limit invalid ();
    end

    localparam integer FRICTION_FRACTION = 16;

    // ---- Summary
    reg summary_unknown;
    reg summary_x_is_free;
    reg signed [17:0] summary_free;
    reg signed [17:0] summary_other;
    reg signed [17:0] summary_slope;
    reg signed [17:0] summary_error_log;
    reg [18*40-1:0] summary_sums; // loaded a cycle after the rest: many bits, first read in the summary's third step
    reg taken;
    reg [5:0] summary_flags;
    reg summary_at_bound;
    reg summary_saturated;
    reg summary_busy;
    reg summary_there;
    reg [1:0] fields_there; // that no output has begun of: without a friction to wait for, two
    wire friction_done;
    wire summary_done;
    wire dependent_clipped;
    wire [6*64-1:0] wrench;
    wire [63:0] friction_quotient;
    wire signed [9:0] friction_exponent;
    wire signed [31:0] angle;
    wire [63:0] error_value;
    wire signed [9:0] error_exponent;
    wire output_idle;
    wire output_start = summary_there && output_idle && ((FIELD == 0) || (fields_there != 2'd0));

    assign answer_take = answer_valid && !summary_busy;
    assign context_take = output_start;

    always @(posedge clock) begin
        taken <= answer_take;
        if (taken) begin
            summary_sums <= sums;
        end
        if (answer_take) begin
            summary_busy <= 1'b1;
            summary_unknown <= unknown;
            summary_x_is_free <= x_is_free;
            summary_free <= free;
            summary_other <= other;
            summary_slope <= slope;
            summary_error_log <= error_log;
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
        .error_log         (summary_error_log),
        .friction_done     (friction_done),
        .done              (summary_done),
        .mu_x              (mu_x),
        .mu_y              (mu_y),
        .dependent_clipped (dependent_clipped),
        .wrench            (wrench),
        .friction_quotient (friction_quotient),
        .friction_exponent (friction_exponent),
        .angle             (angle),
        .error_value       (error_value),
        .error_exponent    (error_exponent)
    );

    // ---- Status: a frame that cannot be trusted says why, and nothing else
    wire no_contact = summary_flags[3];
    wire not_finite = summary_flags[1];
    wire bad_length = summary_flags[0];
    wire bad = not_finite || bad_length;
    wire answered = !bad && !no_contact;
    // Friction |mu_x| + |mu_y| from which on something pulls, 16 fraction bits
    localparam [17:0] PULLING = 18'd22937;
    // Through registers: mu is there long before the output begins, and holds for a cycle after
    reg [17:0] size_x;
    reg [17:0] size_y;
    reg [18:0] size;
    reg pushed;
    reg low_confidence;
    // Of the frame whose output has just begun
    reg several;
    reg replaces;
    reg follows_dropped;
    wire slips;

    always @(posedge clock) begin
        size_x <= mu_x[17] ? -mu_x : mu_x;
        size_y <= mu_y[17] ? -mu_y : mu_y;
        size <= {1'b0, size_x} + {1'b0, size_y};
        pushed <= (size >= {1'b0, PULLING});
        low_confidence <= (THIN != 0) || ((WITH_ERROR != 0) && (summary_error_log > ERROR_LIMIT));
        several <= (contacts > 8'd1);
        replaces <= (replaced != 4'd0);
        follows_dropped <= dropped;
    end

    wire [15:0] status = {
        3'd0,
        follows_dropped,
        answered && summary_flags[5] && (summary_unknown || pushed),
        answered && slips,
        answered && summary_flags[4],
        answered && replaces,
        answered && several,
        answered && low_confidence,
        bad_length,
        not_finite,
        answered && (summary_flags[2] || summary_saturated),
        answered && !summary_unknown && (summary_at_bound || dependent_clipped),
        answered && summary_unknown,
        !bad && no_contact
    };
    // ---- Slip: mu against the limit, which is lower while the frames before slip. Without contact nothing slips; a
    // frame that cannot be trusted changes nothing
    if (SLIP_LIMIT != 18'd0) begin : gen_slip
        // mu with 16 fraction bits: there before the output begins, a cycle behind the quotient
        localparam signed [9:0] FRACTION = FRICTION_FRACTION[9:0];
        wire signed [9:0] down = -(friction_exponent + FRACTION);
        reg [34:0] friction;
        reg slipping; // the frame before slips
        reg output_started; // with the status being loaded

        assign slips = (friction >= {17'd0, slipping ? SLIP_RELEASE : SLIP_LIMIT});

        always @(posedge clock) begin
            // Not below 1: a quotient of 30 bits and more is far above any limit
            friction <= (down < 10'sd1) ? {35{friction_quotient != 64'd0}} : friction_quotient[34:0] >> down;
            output_started <= output_start && !reset;
            if (output_started && !bad) begin
                slipping <= answered && slips;
            end
            if (reset) begin
                slipping <= 1'b0;
            end
        end
    end else begin : gen_none
        assign slips = 1'b0;
        wire _unused_slip = &{1'b0, SLIP_RELEASE};
    end

    // Replaced taxels, version of the calibration, contacts
    wire [31:0] counters = {12'd0, answered ? replaced : 4'd0, version, answered ? contacts : 8'd0};

    // ---- Output
    sptfra_output #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .FIELD            (FIELD),
        .FORCE_LSB        (SUM_LSB - FRICTION_FRACTION),
        .TORQUE_LSB       (TORQUE_LSB - FRICTION_FRACTION),
        .FIELD_LSB        (FIELD_LSB),
        .WORDS            (WORDS),
        .FIELD_STAGES     (FIELD_STAGES),
        .EXPECTED_LATENCY (EXPECTED_OUTPUT_LATENCY)
    ) frame_output (
        .clock             (clock),
        .reset             (reset),
        .start             (output_start),
        .idle              (output_idle),
        .status            (status),
        .timestamp         (timestamp),
        .counters          (counters),
        .exponent          (exponent),
        .blank             (!answered),
        .wrench            (wrench),
        .friction_quotient (friction_quotient),
        .friction_exponent (friction_exponent),
        .angle             (angle),
        .error_value       ((WITH_ERROR != 0) ? error_value : 64'd0),
        .error_exponent    (error_exponent),
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
